// SPDX-License-Identifier: Apache-2.0
#include <iterator>
#include <utility>

#include <io/files/names.hpp>
#include <io/inputs/input_session.hpp>

namespace penumbra::io {
namespace {

/// Opens the targets of the options, else of the input, if there are any.
std::optional<TargetsFile> open_targets(const SessionOptions& options, const RunInput& input) {
  const auto& file = options.targets ? options.targets : input.targets;
  if (!file || options.no_targets) return std::nullopt;
  TargetsFile targets = open_targets(*file, input, options.image);
  if (!input.frame_numbers.empty()) targets.check_frames(input.frame_numbers);
  return targets;
}

Session session_of(const SessionOptions& options, RunInput& input, double target_history) {
  if (!input.camera) {
    input.cloud.target_history = target_history;
    return make_session(input.robot, input.cloud);
  }
  PipelineConfig config = input.config;
  config.backend = options.backend;
  config.renderer = options.renderer;
  config.rule = options.rule.applied_to(config.rule);
  config.image = options.image;
  config.target_history = target_history;
  return make_session(input.robot, *input.camera, config, options.drift, input.camera_info);
}

void append(std::vector<std::string>& lines, std::vector<std::string> more) {
  lines.insert(lines.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
}

}  // namespace

TargetsFile open_targets(const std::filesystem::path& file, const RunInput& input,
                         ImageSpace image) {
  TargetsContext context{.robot = input.robot,
                         .image = image,
                         .images = Intrinsics(1, 1, 1.0, 1.0, 0.0, 0.0),  // scans have no pixels
                         .has_distortion = false,
                         .beyond_hides = input.beyond != BeyondMeans::visible,
                         .stamps = input.stamps};
  if (const auto& camera = input.camera) {
    context.has_distortion = !camera->distortion.is_none();
    const bool is_straight = image == ImageSpace::raw || !context.has_distortion;
    context.images = is_straight ? camera->intrinsics : Rectification(*camera).pinhole();
    context.camera_frame = camera->frame_id;
  }
  return TargetsFile::open(file, context);
}

InputSession::InputSession(const SessionOptions& options, RunInput input)
    : options_(options),
      input_(std::move(input)),
      targets_(open_targets(options, input_)),
      session_(session_of(options, input_, targets_ ? targets_->history() : input_.target_history)),
      source_(input_.frames()) {}

ReportHead InputSession::head() const {
  if (!input_.camera) {
    UsedSettings settings{.rule = {},
                          .robot = input_.robot_options,
                          .targets = targets_ ? targets_->file().string() : std::string(),
                          .target_history = input_.cloud.target_history,
                          .bag = input_.bag,
                          .clouds = input_.used_clouds};
    settings.clouds->rule = input_.cloud.rule;
    return {input_name(options_.input.path),
            {},
            std::move(settings),
            pipeline().robot().links(),
            pipeline().missing_links(),
            pipeline().robot().notes()};
  }
  UsedSettings settings{.rule = pipeline().rule(),
                        .paper_labels = options_.rule.paper_labels,
                        .beyond = input_.beyond.value_or(BeyondMeans::occluded),
                        .image = options_.image,
                        .robot = input_.robot_options,
                        .targets = targets_ ? targets_->file().string() : std::string(),
                        .target_history = targets_ ? targets_->history() : input_.target_history,
                        .bag = input_.bag};
  return {input_name(options_.input.path), pipeline().renderer(),      std::move(settings),
          pipeline().robot().links(),      pipeline().missing_links(), pipeline().robot().notes()};
}

RunResult InputSession::run(const Sinks& sinks, const std::function<bool()>& go_on) {
  RunResult result;
  for (Sink* const sink : sinks) sink->begin(head());
  judge_frames(sinks, go_on, result);
  append(result.notes, source_->notes());
  if (targets_) append(result.notes, targets_->notes());
  append(result.notes, session_.warnings());
  if (!result.device_fault.empty()) result.notes.push_back(result.device_fault);
  for (const Sink* const sink : sinks) append(result.notes, sink->notes());
  if (result.is_stopped)
    result.notes.push_back("stopped after " + std::to_string(result.statistics.frames()) +
                           " frames: later ones are not judged");
  for (Sink* const sink : sinks) sink->finish(result.statistics, result.notes);
  return result;
}

void InputSession::judge_frames(const Sinks& sinks, const std::function<bool()>& go_on,
                                RunResult& result) {
  Frame frame;
  try {
    while (!result.is_stopped && source_->next(frame)) {
      if (targets_) frame.targets = targets_->of_frame(static_cast<std::int64_t>(*frame.index));
      const FrameReport& report = session_.process(frame);
      result.statistics.add(report);
      if (!frame.color_message.empty() && result.frames_without_color++ == 0)
        result.first_without_color = frame.color_message;
      for (Sink* const sink : sinks) sink->take(frame, report);
      result.is_stopped = !go_on();
    }
  } catch (const DeviceError& error) {
    if (result.statistics.frames() == 0) throw;
    result.device_fault = "frame " + std::to_string(frame.index.value_or(0)) +
                          " and later ones are not judged: " + without_device(error);
  }
  result.statistics.set_drift(session_.drift());
  result.statistics.set_diagnosis(session_.diagnosis());
}

Session make_session(Robot robot, const Camera& camera, const PipelineConfig& config,
                     const DriftLimits& limits, const std::filesystem::path& camera_info) {
  try {
    return {std::move(robot), camera, config, limits};
  } catch (const LensError& error) {
    throw InputError(camera_info.string() + ": " + error.what());
  }
}

std::string without_device(const DeviceError& error) {
  return std::string(error.what()) + "; run again, or with --renderer cpu";
}

}  // namespace penumbra::io
