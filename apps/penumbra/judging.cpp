// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <span>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/sequence_notes.hpp>
#include <penumbra/tuning/missing_parts.hpp>

#include <apps/penumbra/judging.hpp>
#include <apps/penumbra/text.hpp>

namespace penumbra::app {
namespace {

constexpr int device_failed = 1;  // exit status

/// The camera whose images the report is of.
Camera camera_of_report(const RunArguments& arguments, const Camera& camera) {
  if (arguments.image == ImageSpace::raw || camera.distortion.is_none()) return camera;
  return {.intrinsics = Rectification(camera).pinhole(),
          .distortion = {},
          .range = camera.range,
          .frame_id = camera.frame_id};
}

/// Targets of the command line before those of the input; nothing: none.
std::optional<io::TargetsFile> open_targets(const RunArguments& arguments, const RunInput& input,
                                            const Camera& camera) {
  const auto& file = arguments.targets ? arguments.targets : input.targets;
  if (!file || arguments.no_targets) return std::nullopt;
  return io::TargetsFile::open(*file, {.robot = input.robot,
                                       .image = arguments.image,
                                       .images = camera.intrinsics,
                                       .is_bent = !input.camera.distortion.is_none(),
                                       .beyond_hides = input.beyond != io::BeyondMeans::visible,
                                       .camera_frame = camera.frame_id});
}

/// Takes the input's robot.
Pipeline make_pipeline(const RunArguments& arguments, RunInput& input, double target_history) {
  PipelineConfig config = input.config;
  config.backend = arguments.renderer.backend;
  config.renderer = arguments.renderer.options;
  config.rule = rule_of(arguments, config.rule);
  config.image = arguments.image;
  config.target_history = target_history;
  return app::make_pipeline(std::move(input.robot), input.camera, config, input.camera_info);
}

io::UsedSettings settings_of(const RunArguments& arguments, const RunInput& input,
                             const Pipeline& pipeline,
                             const std::optional<io::TargetsFile>& targets) {
  return {.rule = pipeline.rule(),
          .paper_labels = arguments.paper_labels,
          .beyond = input.beyond.value_or(io::BeyondMeans::occluded),
          .image = arguments.image,
          .robot = input.robot_options,
          .targets = targets ? targets->file().string() : std::string(),
          .target_history = targets ? targets->history() : input.target_history,
          .bag = input.bag};
}

}  // namespace

Judging::Judging(const RunArguments& arguments)
    : arguments_(arguments),
      input_(open_input(arguments, std::cout)),
      camera_(camera_of_report(arguments, input_.camera)),
      targets_(open_targets(arguments, input_, camera_)),
      pipeline_(
          make_pipeline(arguments, input_, targets_ ? targets_->history() : input_.target_history)),
      source_(input_.frames(pipeline_.robot())) {}

io::ReportHead Judging::head() const {
  return {arguments_.input.string(),
          pipeline_.renderer(),
          settings_of(arguments_, input_, pipeline_, targets_),
          pipeline_.robot().links(),
          pipeline_.missing_links(),
          pipeline_.robot().notes()};
}

bool Judging::run(RunOutput& output, const std::function<bool()>& go_on) {
  judge_frames(output, go_on);
  late_notes_ = source_->notes();
  late_notes_.insert(late_notes_.end(), sequence_notes_.begin(), sequence_notes_.end());
  if (!lost_.empty()) late_notes_.push_back(lost_);
  for (std::string& note : output.notes()) late_notes_.push_back(std::move(note));
  if (stopped_)
    late_notes_.push_back("stopped after " + std::to_string(statistics_.frames()) +
                          " frames: later ones are not judged");
  output.finish(statistics_, late_notes_);
  return !stopped_;
}

void Judging::judge_frames(RunOutput& output, const std::function<bool()>& go_on) {
  SequenceNotes doubts(pipeline_.robot(), {.image = arguments_.image});
  MissingParts missing(pipeline_.robot(), pipeline_.rule().fringe_reach);
  io::FrameData data;
  Frame frame;
  try {
    while (!stopped_ && source_->next(data, frame)) {
      if (targets_) frame.targets = targets_->of_frame(data.index);
      const FrameReport& report = pipeline_.process(frame);
      statistics_.add(report);
      doubts.add(report, frame.joints.positions);
      missing.add(report);
      color_.add(data.color_message);
      output.save(report, data, {frame.targets, pipeline_.robot(), camera_});
      stopped_ = !go_on();
    }
  } catch (const DeviceError& error) {
    if (statistics_.frames() == 0) throw;
    lost_ = "frame " + std::to_string(data.index) +
            " and later ones are not judged: " + without_device(error);
  }
  sequence_notes_ = doubts.lines();
  for (std::string& line : missing.lines()) sequence_notes_.push_back(std::move(line));
}

void Judging::tell(const std::string& where) const {
  if (statistics_.usable_frames() > 0) tell_notes(pipeline_.robot().notes());
  tell_faults(statistics_, color_);
  tell_notes(late_notes_);
  tell_summary(statistics_, where);
}

int Judging::status() const {
  if (!lost_.empty()) return device_failed;
  return statistics_.usable_frames() > 0 ? 0 : 2;
}

LabelRule rule_of(const RunArguments& arguments, const LabelRule& recorded) {
  LabelRule rule = arguments.paper_labels ? LabelRule::paper() : recorded;
  if (arguments.sensor) {
    const LabelRule sensor = LabelRule::for_sensor(*arguments.sensor);
    rule.tolerance = sensor.tolerance;
    rule.fringe_reach = sensor.fringe_reach;
  }
  if (arguments.tolerance) rule.tolerance = *arguments.tolerance;
  if (arguments.front_min_width) rule.front_min_width = *arguments.front_min_width;
  if (arguments.fringe_reach) rule.fringe_reach = *arguments.fringe_reach;
  return rule;
}

}  // namespace penumbra::app
