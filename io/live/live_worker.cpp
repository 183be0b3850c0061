// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>

#include <io/live/live_worker.hpp>

namespace penumbra::io {
namespace {

/// Frames of this time are diagnosed together, in nanoseconds; at first less, so that a wrong setup
/// is named soon.
constexpr std::int64_t first_warnings_after = 5'000'000'000, warnings_period = 60'000'000'000;

}  // namespace

LiveWorker::Tools LiveWorker::make_tools(const SensorSetup& setup) const {
  const Robot& robot = setup.posed->robot;
  if (setup.cloud() != nullptr) {
    const CloudOutput how = options_.clouds[sensor_ - options_.cameras.size()].output;
    return {.session = Session(robot, *setup.cloud()), .encoder = ResultEncoder(robot, how)};
  }
  const JudgedCameras& cameras = *setup.cameras();
  PipelineConfig config = config_;
  config.has_depth = cameras.has_depth;
  Tools tools{.session = Session(robot, cameras.judged, config, options_.drift),
              .encoder = ResultEncoder(robot, cameras.judged, options_.points),
              .depth = DepthInput(cameras)};
  if (calibration_ != nullptr)
    calibration_->follow(robot, cameras.judged, cameras.judged.parent, cameras.judged.pose());
  return tools;
}

bool LiveWorker::follow(const std::shared_ptr<SensorSetup>& setup) {
  if (setup == setup_) return tools_.has_value();
  tools_.reset();
  setup_ = setup;
  fault_.clear();
  next_warnings_.reset();
  has_warned_ = false;
  try {
    tools_.emplace(make_tools(*setup));
  } catch (const InputError& error) {
    fault_ = error.what();
  }
  return tools_.has_value();
}

LiveOutcome LiveWorker::judge(AssembledFrame& job, ResultSink& sink, FrameWatcher* watcher,
                              std::span<const Result> skipped) {
  LiveOutcome outcome;
  outcome.stamp = job.stamp.value_or(0);
  outcome.arrived = job.arrived;
  if (!follow(job.setup)) {
    outcome.fault = fault_;
    outcome.unjudged_targets = job.targets.size();
    return outcome;
  }
  job.index = judged_++;
  if (job.pose_at && poses_ != nullptr)
    job.pose_at = [this, pose_at = std::move(job.pose_at)](std::int64_t stamp, RobotPose& pose) {
      const std::lock_guard lock(*poses_);
      pose_at(stamp, pose);
    };
  if (tools_->depth) static_cast<void>(tools_->depth->read(job));
  Session& session = tools_->session;
  if (!job.scan && !job.setup->cameras()->has_depth && *job.index % SetupCheck::color_step == 0)
    show_color(job, true);
  const FrameReport& report = session.process(job);
  if (const Pipeline& pipeline = session.pipeline(); !job.scan) {
    const bool draws = std::ranges::find(skipped, Result::overlay) == skipped.end();
    show_color(job, draws && sink.wants(Result::overlay));
    outcome.views = views_of({{}, pipeline.intrinsics(), pipeline.rule().tolerance}, report);
    outcome.renderer = pipeline.renderer();
  }
  tools_->encoder.encode(job, report, sink, skipped);
  outcome.drift = session.drift();
  if (calibration_ != nullptr) calibration_->take(job, outcome.drift);
  if (watcher != nullptr) watcher->take(job, report, outcome.drift);
  outcome.is_published = true;
  outcome.status = report.status;
  outcome.message = report.message;
  outcome.timing = report.timing;
  outcome.pixels = report.pixels;
  outcome.parts = report.parts;
  if (job.scan) outcome.time_note = job.scan->received->points.time_note;
  find_warnings(job.arrived, outcome);
  return outcome;
}

/// Once in a while, gives the warnings to another thread. Later ones replace the first ones only if
/// the robot moved meanwhile: while it rests, frames show less, and a wrong setup would look right.
void LiveWorker::find_warnings(std::int64_t now, LiveOutcome& outcome) {
  if (!next_warnings_) next_warnings_ = now + first_warnings_after;
  if (now < *next_warnings_) return;
  const std::size_t poses = tools_->session.poses();  // 0 of clouds without rays
  if (has_warned_ && (tools_->depth || poses > 0) && poses < KeptFrames::least) return;
  has_warned_ = true;
  next_warnings_ = now + warnings_period;
  outcome.find_warnings = tools_->session.take_warnings();
}

void LiveWorker::show_color(AssembledFrame& job, bool wanted) {
  if (wanted && job.color_image &&
      decode_color(*job.color_image, job.setup->cameras()->judged, color_).empty())
    job.color = std::as_const(color_).view();
}

}  // namespace penumbra::io
