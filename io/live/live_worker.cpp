// SPDX-License-Identifier: Apache-2.0
#include <type_traits>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>

#include <io/live/live_worker.hpp>

namespace penumbra::io {
namespace {

/// Forwards all results except overlays.
class WithoutOverlay final : public ResultSink {
 public:
  explicit WithoutOverlay(ResultSink& to) : to_(to) {}
  [[nodiscard]] bool wants(Result result) const override {
    return result != Result::overlay && to_.wants(result);
  }
  void write(Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    to_.write(result, stamp, payload);
  }

 private:
  ResultSink& to_;
};

PipelineConfig config_of(const LiveSetup& setup, PipelineConfig config) {
  config.camera_parent = setup.mount.parent;
  config.T_parent_camera = setup.mount.T_parent_camera;
  return config;
}

}  // namespace

LiveWorker::Tools::Tools(const LiveSetup& setup, const PipelineConfig& config)
    : pipeline(setup.posed->robot, setup.cameras.judged, config_of(setup, config)),
      encoder(setup.cameras.judged, setup.posed->robot.links().front()),
      depth(setup.cameras.judged, setup.cameras.depth) {}

bool LiveWorker::follow(const std::shared_ptr<LiveSetup>& setup) {
  if (setup == setup_) return tools_ != nullptr;
  tools_.reset();
  setup_ = setup;
  fault_.clear();
  try {
    tools_ = std::make_unique<Tools>(*setup, config_);
  } catch (const InputError& error) {
    fault_ = error.what();
  }
  return tools_ != nullptr;
}

LiveOutcome LiveWorker::judge(LiveJob& job, ResultSink& sink, FrameWatcher* watcher) {
  LiveOutcome outcome;
  outcome.stamp = job.pose.stamp;
  outcome.arrived = job.arrived;
  if (!follow(job.setup)) {
    outcome.fault = fault_;
    outcome.unjudged_targets = job.targets.size();
    return outcome;
  }
  Frame frame = job.pose.frame();
  frame.targets = job.targets;
  frame.index = judged_++;
  message_ = frame.source_message;
  if (const std::string fault = read_depth(job, frame.depth); !fault.empty()) {
    message_ += (message_.empty() ? "" : "; ") + fault;
    if (frame.source_status == FrameStatus::ok) frame.source_status = FrameStatus::bad_depth;
    frame.depth = no_depth_;
  }
  frame.source_message = message_;
  const FrameReport& report = tools_->pipeline.process(frame);
  WithoutOverlay without_overlay(sink);
  ResultSink& taken = job.with_overlay ? sink : without_overlay;
  show_color(job, taken.wants(Result::overlay));
  tools_->encoder.encode(report, {frame.depth, std::as_const(color_).view()},
                         {frame.targets, tools_->pipeline.robot(), job.setup->cameras.judged},
                         taken);
  if (watcher != nullptr) watcher->take(job, frame.depth, report);
  outcome.is_published = true;
  outcome.status = report.status;
  outcome.message = report.message;
  outcome.timing = report.timing;
  outcome.renderer = tools_->pipeline.renderer();
  return outcome;
}

std::string LiveWorker::read_depth(const LiveJob& job, DepthView& depth) {
  std::string fault = job.image.image ? tools_->depth.decode(*job.image.image, depth)
                                      : tools_->depth.decode(*job.image.compressed, depth);
  if (fault.empty()) {
    std::visit([this](const auto& view) { no_depth_ = std::decay_t<decltype(view)>(); }, depth);
    fault = tools_->depth.check_size(depth);
  }
  if (!fault.empty() || !tools_->depth.is_of_other_camera()) return fault;
  if (!has_pose(job.pose.pose.status)) {
    depth = no_depth_;  // its position is not known
    return {};
  }
  return tools_->depth.bring(job.T_judged_depth, depth);
}

void LiveWorker::show_color(const LiveJob& job, bool wanted) {
  const bool shown =
      wanted && job.color && decode_color(*job.color, job.setup->cameras.judged, color_).empty();
  if (!shown) color_ = {};
}

}  // namespace penumbra::io
