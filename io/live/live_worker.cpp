// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/live/live_worker.hpp>

namespace penumbra::io {
namespace {

PipelineConfig config_of(const CameraSetup& setup, PipelineConfig config) {
  config.camera_parent = setup.mount.parent;
  config.T_parent_camera = setup.mount.T_parent_camera;
  return config;
}

}  // namespace

LiveWorker::Tools::Tools(const CameraSetup& setup, const PipelineConfig& config,
                         const DriftLimits& limits)
    : pipeline(setup.posed->robot, setup.cameras.judged, config_of(setup, config)),
      encoder(setup.cameras.judged, setup.posed->robot.links().front()),
      depth(setup.cameras),
      watch(setup.cameras.judged, limits) {}

bool LiveWorker::follow(const std::shared_ptr<CameraSetup>& setup) {
  if (setup == setup_) return tools_ != nullptr;
  tools_.reset();
  setup_ = setup;
  fault_.clear();
  try {
    tools_ = std::make_unique<Tools>(*setup, config_, limits_);
  } catch (const InputError& error) {
    fault_ = error.what();
  }
  return tools_ != nullptr;
}

LiveOutcome LiveWorker::judge(AssembledFrame& job, ResultSink& sink, FrameWatcher* watcher) {
  LiveOutcome outcome;
  outcome.stamp = job.pose.stamp;
  outcome.arrived = job.arrived;
  if (!follow(job.setup)) {
    outcome.fault = fault_;
    outcome.unjudged_targets = job.targets.size();
    return outcome;
  }
  Frame frame;
  static_cast<void>(tools_->depth.read(job, frame, message_));
  frame.index = judged_++;
  const FrameReport& report = tools_->pipeline.process(frame);
  show_color(job, sink.wants(Result::overlay));
  tools_->encoder.encode(report, {frame.depth, std::as_const(color_).view()},
                         {frame.targets, tools_->pipeline.robot(), job.setup->cameras.judged},
                         sink);
  tools_->watch.add(report);
  outcome.drift = tools_->watch.drift();
  if (watcher != nullptr) watcher->take(job, frame.depth, report, outcome.drift);
  outcome.is_published = true;
  outcome.views =
      views_of({{}, tools_->pipeline.intrinsics(), tools_->pipeline.rule().tolerance}, report);
  outcome.status = report.status;
  outcome.message = report.message;
  outcome.timing = report.timing;
  outcome.renderer = tools_->pipeline.renderer();
  return outcome;
}

void LiveWorker::show_color(const AssembledFrame& job, bool wanted) {
  const bool shown =
      wanted && job.color && decode_color(*job.color, job.setup->cameras.judged, color_).empty();
  if (!shown) color_ = {};
}

}  // namespace penumbra::io
