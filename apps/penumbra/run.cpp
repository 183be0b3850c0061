// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/sequence_notes.hpp>
#include <penumbra/pipeline/statistics.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/former_results.hpp>
#include <apps/penumbra/output_bag.hpp>
#include <apps/penumbra/output_folder.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/run_input.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <apps/penumbra/text.hpp>
#include <io/pending_file.hpp>
#include <io/report_json.hpp>
#include <io/targets_file.hpp>

namespace penumbra::app {
namespace {

constexpr int device_failed = 1;  // exit status

/// What an earlier run wrote will be removed or replaced: nothing else may stand there.
void check_output(const RunArguments& arguments) {
  std::error_code error;
  const std::filesystem::path input = std::filesystem::absolute(arguments.input);
  const std::filesystem::path& output = arguments.output;
  if (is_output_bag(output)) {
    if (std::filesystem::equivalent(output, input, error))
      throw InputError("--output: " + output.string() + " is the input; choose another name");
    return check_former_bag(output);
  }
  const bool is_own = std::filesystem::equivalent(output, input, error) ||
                      (std::filesystem::is_regular_file(input, error) &&
                       std::filesystem::equivalent(output, input.parent_path(), error));
  if (is_own)
    throw InputError("--output: " + output.string() +
                     " is the recording's own folder; choose another, or one inside of it");
  if (std::filesystem::exists(output / "recording.yaml", error))
    throw InputError("--output: " + output.string() +
                     " is a recording (it has a recording.yaml); choose another folder");
  check_former_run(output);
}

/// Of an error's message: that an earlier run's results still stand.
std::string left_of(const RunArguments& arguments) {
  const bool is_bag = is_output_bag(arguments.output);
  return io::left_as_it_was(is_bag ? arguments.output : arguments.output / "report.json");
}

/// Makes room for the results in a folder; a bag takes the place of an earlier one at the end.
std::unique_ptr<RunOutput> open_output(const RunArguments& arguments, const RunInput& input,
                                       const Pipeline& pipeline) {
  if (is_output_bag(arguments.output))
    return std::make_unique<OutputBag>(arguments.output, input.camera,
                                       pipeline.robot().links().front());
  remove_former_run(arguments.output);
  return std::make_unique<OutputFolder>(arguments.output, arguments.saves,
                                        pipeline.rectification());
}

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
  config.labels_on_device = arguments.gl_labels;
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
          .target_history = targets ? targets->history() : input.target_history};
}

/// Where a later frame's joints put the camera inside of a link, that frame is bad and the others
/// are judged; where no frame before was usable, it is the recording that is wrong.
const FrameReport& judge(Pipeline& pipeline, Frame frame, const Statistics& before) {
  try {
    return pipeline.process(frame);
  } catch (const InputError& error) {
    if (before.usable_frames() == 0) throw;
    std::string message(frame.source_message);
    message += (message.empty() ? "" : "; ") + std::string(error.what());
    frame.source_status = FrameStatus::missing_transform;
    frame.source_message = message;
    return pipeline.process(frame);
  }
}

/// Notes the warnings that the renderer's choice gets while frames are judged.
class RendererWatch {
 public:
  explicit RendererWatch(const Pipeline& pipeline)
      : pipeline_(pipeline), seen_(pipeline.renderer_choice().warnings.size()) {}

  void look(std::size_t index) {
    const auto& warnings = pipeline_.renderer_choice().warnings;
    for (; seen_ < warnings.size(); ++seen_)
      notes_.push_back("frame " + std::to_string(index) + ": " + warnings[seen_]);
  }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  const Pipeline& pipeline_;
  std::size_t seen_;
  std::vector<std::string> notes_;
};

/// What the frames gave rise to; `lost`: why later ones are not judged, if any.
std::vector<std::string> notes_of_frames(const io::FrameSource& source, const SequenceNotes& doubts,
                                         const RendererWatch& watch, const std::string& lost) {
  std::vector<std::string> lines = source.notes();
  for (const auto& more : {doubts.lines(), watch.notes()})
    lines.insert(lines.end(), more.begin(), more.end());
  if (!lost.empty()) lines.push_back(lost);
  return lines;
}

int judge_all(const RunArguments& arguments) {
  RunInput input = open_input(arguments);
  const Camera camera = camera_of_report(arguments, input.camera);
  auto targets = open_targets(arguments, input, camera);
  Pipeline pipeline =
      make_pipeline(arguments, input, targets ? targets->history() : input.target_history);
  const auto source = input.frames(pipeline.robot());
  tell_choice(pipeline.renderer_choice());
  const std::vector<std::string> notes = notes_of(pipeline);

  const auto output = open_output(arguments, input, pipeline);
  output->begin({arguments.input.string(), io::used_renderer(pipeline, arguments.renderer.backend),
                 settings_of(arguments, input, pipeline, targets), pipeline.robot().links(),
                 pipeline.missing_links(), notes});
  Statistics statistics;
  SequenceNotes doubts(pipeline.robot(), {.image = arguments.image});
  ColorFaults color;
  RendererWatch watch(pipeline);
  std::string lost;  // why later frames are not judged
  io::FrameData data;
  Frame frame;
  try {
    Progress progress(source->size().value_or(0));
    while (source->next(data, frame)) {
      if (targets) frame.targets = targets->of_frame(data.index);
      const FrameReport& report = judge(pipeline, frame, statistics);
      statistics.add(report);
      doubts.add(report, frame.joints.positions);
      color.add(data.color_message);
      watch.look(report.index);
      output->save(report, data, {frame.targets, pipeline.robot(), camera});
      progress.step();
    }
  } catch (const DeviceError& error) {
    if (statistics.frames() == 0) throw;
    lost = "frame " + std::to_string(data.index) +
           " and later ones are not judged: " + without_device(error);
  }
  std::vector<std::string> late_notes = notes_of_frames(*source, doubts, watch, lost);
  for (std::string& note : output->notes()) late_notes.push_back(std::move(note));
  output->finish(statistics, late_notes);
  if (statistics.usable_frames() > 0) tell_notes(pipeline.robot().notes());
  tell_faults(statistics, color);
  tell_notes(late_notes);
  tell_summary(statistics, output->where());
  if (!lost.empty()) return device_failed;
  return statistics.usable_frames() > 0 ? 0 : 2;
}

}  // namespace

LabelRule rule_of(const RunArguments& arguments, const LabelRule& recorded) {
  LabelRule rule = arguments.paper_labels ? LabelRule::paper() : recorded;
  if (arguments.tolerance) rule.tolerance = *arguments.tolerance;
  if (arguments.front_min_width) rule.front_min_width = *arguments.front_min_width;
  return rule;
}

int execute(const RunArguments& arguments) {
  check_output(arguments);
  return run_or_tell_left([&] { return judge_all(arguments); }, [&] { return left_of(arguments); });
}

}  // namespace penumbra::app
