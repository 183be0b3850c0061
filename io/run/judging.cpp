// SPDX-License-Identifier: Apache-2.0
#include <iterator>
#include <utility>

#include <io/files/sequence_notes.hpp>
#include <io/run/judging.hpp>

namespace penumbra::io {
namespace {

/// The camera of the report's images.
Camera camera_of_report(ImageSpace image, const Camera& camera) {
  if (image == ImageSpace::raw || camera.distortion.is_none()) return camera;
  return {.intrinsics = Rectification(camera).pinhole(),
          .distortion = {},
          .range = camera.range,
          .frame_id = camera.frame_id};
}

/// Opens the targets of the options, else of the input, if there are any.
std::optional<TargetsFile> open_targets(const JudgingOptions& options, const RunInput& input,
                                        const Camera& camera) {
  const auto& file = options.targets ? options.targets : input.targets;
  if (!file || options.no_targets) return std::nullopt;
  return TargetsFile::open(*file, {.robot = input.robot,
                                   .image = options.image,
                                   .images = camera.intrinsics,
                                   .is_bent = !input.camera.distortion.is_none(),
                                   .beyond_hides = input.beyond != BeyondMeans::visible,
                                   .camera_frame = camera.frame_id});
}

/// Takes the input's robot.
Pipeline pipeline_of(const JudgingOptions& options, RunInput& input, double target_history) {
  PipelineConfig config = input.config;
  config.backend = options.backend;
  config.renderer = options.renderer;
  config.rule = options.rule.applied_to(config.rule);
  config.image = options.image;
  config.target_history = target_history;
  return make_pipeline(std::move(input.robot), input.camera, config, input.camera_info);
}

void append(std::vector<std::string>& lines, std::vector<std::string> more) {
  lines.insert(lines.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
}

}  // namespace

Judging::Judging(const JudgingOptions& options, const LineSink& print)
    : options_(options),
      input_(open_input(options.input, print)),
      camera_(camera_of_report(options.image, input_.camera)),
      targets_(open_targets(options, input_, camera_)),
      pipeline_(
          pipeline_of(options, input_, targets_ ? targets_->history() : input_.target_history)),
      source_(input_.frames(pipeline_.robot())) {}

ReportHead Judging::head() const {
  UsedSettings settings{.rule = pipeline_.rule(),
                        .paper_labels = options_.rule.paper_labels,
                        .beyond = input_.beyond.value_or(BeyondMeans::occluded),
                        .image = options_.image,
                        .robot = input_.robot_options,
                        .targets = targets_ ? targets_->file().string() : std::string(),
                        .target_history = targets_ ? targets_->history() : input_.target_history,
                        .bag = input_.bag};
  return {options_.input.path.string(), pipeline_.renderer(),      std::move(settings),
          pipeline_.robot().links(),    pipeline_.missing_links(), pipeline_.robot().notes()};
}

RunResult Judging::run(RunOutput& output, const std::function<bool()>& go_on) {
  RunResult result;
  std::vector<std::string> of_frames = judge_frames(output, go_on, result);
  append(result.notes, source_->notes());
  append(result.notes, std::move(of_frames));
  if (!result.device_fault.empty()) result.notes.push_back(result.device_fault);
  append(result.notes, output.notes());
  if (result.is_stopped)
    result.notes.push_back("stopped after " + std::to_string(result.statistics.frames()) +
                           " frames: later ones are not judged");
  output.finish(result.statistics, result.notes);
  return result;
}

std::vector<std::string> Judging::judge_frames(RunOutput& output,
                                               const std::function<bool()>& go_on,
                                               RunResult& result) {
  PipelineConfig config = input_.config;
  config.image = options_.image;
  SequenceNotes sequence(pipeline_, camera_, config, options_.drift);
  FrameData data;
  Frame frame;
  try {
    while (!result.is_stopped && source_->next(data, frame)) {
      if (targets_) frame.targets = targets_->of_frame(data.index);
      const FrameReport& report = pipeline_.process(frame);
      result.statistics.add(report);
      sequence.add(report, frame.joints.positions);
      if (!data.color_message.empty() && result.frames_without_color++ == 0)
        result.first_without_color = data.color_message;
      output.save(report, data, {frame.targets, pipeline_.robot(), camera_});
      result.is_stopped = !go_on();
    }
  } catch (const DeviceError& error) {
    if (result.statistics.frames() == 0) throw;
    result.device_fault = "frame " + std::to_string(data.index) +
                          " and later ones are not judged: " + without_device(error);
  }
  result.statistics.set_drift(sequence.drift());
  result.statistics.set_diagnosis(sequence.diagnosis());
  return sequence.lines();
}

LabelRule RuleOptions::applied_to(const LabelRule& recorded) const {
  LabelRule rule = paper_labels ? LabelRule::paper() : recorded;
  if (sensor) {
    const LabelRule of_sensor = LabelRule::for_sensor(*sensor);
    rule.tolerance = of_sensor.tolerance;
    rule.fringe_reach = of_sensor.fringe_reach;
  }
  if (tolerance) rule.tolerance = *tolerance;
  if (front_min_width) rule.front_min_width = *front_min_width;
  if (fringe_reach) rule.fringe_reach = *fringe_reach;
  return rule;
}

Pipeline make_pipeline(Robot robot, const Camera& camera, const PipelineConfig& config,
                       const std::filesystem::path& camera_info) {
  try {
    return {std::move(robot), camera, config};
  } catch (const LensError& error) {
    throw InputError(camera_info.string() + ": " + error.what());
  }
}

std::string without_device(const DeviceError& error) {
  return std::string(error.what()) + "; run again, or with --renderer cpu";
}

}  // namespace penumbra::io
