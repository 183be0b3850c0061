// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/live/live_worker.hpp>

namespace penumbra::io {
namespace {

/// Frames of this time are diagnosed together, in nanoseconds; at first less, so that a wrong setup
/// is named soon.
constexpr std::int64_t first_warnings_after = 5'000'000'000, warnings_period = 60'000'000'000;

PipelineConfig config_of(const CameraSetup& setup, PipelineConfig config) {
  config.has_depth = setup.cameras.has_depth;
  config.camera_parent = setup.mount.parent;
  config.T_parent_camera = setup.mount.T_parent_camera;
  return config;
}

}  // namespace

LiveWorker::Tools::Tools(const CameraSetup& setup, const PipelineConfig& config,
                         const DriftLimits& limits, const PointsRule& points)
    : session(setup.posed->robot, setup.cameras.judged, config_of(setup, config), limits),
      encoder(setup.cameras.judged, setup.posed->robot.links().front(), points),
      depth(setup.cameras) {}

bool LiveWorker::follow(const std::shared_ptr<CameraSetup>& setup) {
  if (setup == setup_) return tools_ != nullptr;
  tools_.reset();
  setup_ = setup;
  fault_.clear();
  next_warnings_.reset();
  has_warned_ = false;
  try {
    tools_ = std::make_unique<Tools>(*setup, config_, limits_, points_);
  } catch (const InputError& error) {
    fault_ = error.what();
  }
  return tools_ != nullptr;
}

LiveOutcome LiveWorker::judge(AssembledFrame& job, ResultSink& sink, FrameWatcher* watcher) {
  LiveOutcome outcome;
  outcome.stamp = job.stamp.value_or(0);
  outcome.arrived = job.arrived;
  if (!follow(job.setup)) {
    outcome.fault = fault_;
    outcome.unjudged_targets = job.targets.size();
    return outcome;
  }
  static_cast<void>(tools_->depth.read(job));
  job.index = judged_++;
  Session& session = tools_->session;
  const Pipeline& pipeline = session.pipeline();
  const FrameReport& report = session.process(job);
  show_color(job, sink.wants(Result::overlay));
  tools_->encoder.encode(report, {job.depth.view, std::as_const(color_).view()},
                         {job.targets, pipeline.robot(), job.setup->cameras.judged}, sink);
  outcome.drift = session.drift();
  if (watcher != nullptr) watcher->take(job, job.depth.view, report, outcome.drift);
  outcome.is_published = true;
  outcome.views = views_of({{}, pipeline.intrinsics(), pipeline.rule().tolerance}, report);
  outcome.status = report.status;
  outcome.message = report.message;
  outcome.timing = report.timing;
  outcome.renderer = pipeline.renderer();
  find_warnings(job.arrived, outcome);
  return outcome;
}

/// Once in a while, gives the warnings to another thread. Later ones replace the first ones only if
/// the robot moved meanwhile: while it rests, frames show less, and a wrong setup would look right.
void LiveWorker::find_warnings(std::int64_t now, LiveOutcome& outcome) {
  if (!next_warnings_) next_warnings_ = now + first_warnings_after;
  if (now < *next_warnings_) return;
  if (has_warned_ && tools_->session.poses() < CalibrationFrames::least) return;
  has_warned_ = true;
  next_warnings_ = now + warnings_period;
  const auto taken = std::make_shared<const Warnings>(tools_->session.take_warnings());
  outcome.find_warnings = [taken] { return taken->lines(); };
}

void LiveWorker::show_color(const AssembledFrame& job, bool wanted) {
  const bool shown = wanted && job.color_image &&
                     decode_color(*job.color_image, job.setup->cameras.judged, color_).empty();
  if (!shown) color_ = {};
}

}  // namespace penumbra::io
