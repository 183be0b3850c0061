// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/sequence_notes.hpp>
#include <penumbra/pipeline/statistics.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/former_results.hpp>
#include <apps/penumbra/output_folder.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/text.hpp>
#include <io/frame_reader.hpp>
#include <io/names.hpp>
#include <io/recording.hpp>
#include <io/report_json.hpp>
#include <io/targets_file.hpp>

namespace penumbra::app {
namespace {

constexpr int device_failed = 1;          // exit status
constexpr std::size_t most_targets = 20;  // that are told of by a line each

io::Recording open_recording(const RunArguments& arguments) {
  if (arguments.input.extension() == ".mcap")
    throw InputError(arguments.input.string() +
                     ": ROS 2 bags are not supported by this build; give a recording folder");
  io::Recording recording = io::Recording::open(arguments.input);
  if (arguments.geometry) recording.robot.geometry = *arguments.geometry;
  recording.robot.geometry_fallback |= arguments.geometry_fallback;
  recording.robot.allow_missing_meshes |= arguments.allow_missing_meshes;
  return recording;
}

/// What an earlier run wrote is removed from the output folder: it must be no recording.
void check_output(const RunArguments& arguments) {
  std::error_code error;
  const std::filesystem::path input = std::filesystem::absolute(arguments.input);
  const std::filesystem::path& output = arguments.output;
  const bool is_own = std::filesystem::equivalent(output, input, error) ||
                      (std::filesystem::is_regular_file(input, error) &&
                       std::filesystem::equivalent(output, input.parent_path(), error));
  if (is_own)
    throw InputError("--output: " + output.string() +
                     " is the recording's own folder; choose another, or one inside of it");
  if (std::filesystem::exists(output / "recording.yaml", error))
    throw InputError("--output: " + output.string() +
                     " is a recording (it has a recording.yaml); choose another folder");
}

/// The command line's choice before the recording's before the default.
LabelRule rule_of(const RunArguments& arguments, const LabelRule& recorded) {
  LabelRule rule = arguments.paper_labels ? LabelRule::paper() : recorded;
  if (arguments.tolerance) rule.tolerance = *arguments.tolerance;
  if (arguments.front_min_width) rule.front_min_width = *arguments.front_min_width;
  return rule;
}

/// The camera whose images the report is of.
Camera camera_of_report(const RunArguments& arguments, const Camera& camera) {
  if (arguments.image == ImageSpace::raw || camera.distortion.is_none()) return camera;
  return {.intrinsics = Rectification(camera).pinhole(),
          .distortion = {},
          .range = camera.range,
          .frame_id = camera.frame_id};
}

/// Targets of the command line before those of the recording; nothing: none.
std::optional<io::TargetsFile> open_targets(const RunArguments& arguments,
                                            const io::Recording& recording, const Robot& robot,
                                            const Camera& camera) {
  const auto& file = arguments.targets ? arguments.targets : recording.targets;
  if (!file || arguments.no_targets) return std::nullopt;
  if (arguments.gl_labels)
    throw InputError(
        file->string() +
        ": targets cannot be judged with --gl-labels; leave that out, or add --targets "
        "none");
  return io::TargetsFile::open(
      *file, {.robot = robot,
              .image = arguments.image,
              .images = camera.intrinsics,
              .is_bent = !recording.camera.camera.distortion.is_none(),
              .beyond_hides = recording.camera.beyond != io::BeyondMeans::visible});
}

Pipeline make_pipeline(const RunArguments& arguments, const io::Recording& recording, Robot robot,
                       double target_history) {
  const io::RecordingCamera& camera = recording.camera;
  if (!robot.find_link(camera.parent)) {
    const std::vector<std::string_view> known(robot.links().begin(), robot.links().end());
    throw InputError(recording.file.string() + ": camera.parent: '" + camera.parent +
                     "' is no link of the robot" + io::near_names(camera.parent, known));
  }
  PipelineConfig config = recording.pipeline_config();
  config.backend = arguments.renderer.backend;
  config.renderer = arguments.renderer.options;
  config.labels_on_device = arguments.gl_labels;
  config.rule = rule_of(arguments, config.rule);
  config.image = arguments.image;
  config.target_history = target_history;
  return app::make_pipeline(std::move(robot), camera.camera, config, camera.info);
}

io::UsedSettings settings_of(const RunArguments& arguments, const io::Recording& recording,
                             const Pipeline& pipeline,
                             const std::optional<io::TargetsFile>& targets) {
  return {.rule = pipeline.rule(),
          .paper_labels = arguments.paper_labels,
          .beyond = recording.camera.beyond.value_or(io::BeyondMeans::occluded),
          .image = arguments.image,
          .robot = recording.robot,
          .targets = targets ? targets->file().string() : std::string(),
          .target_history = targets ? targets->history() : 0.0};
}

/// Which of the reader's frames are wanted; the range must lie inside the recording.
std::vector<std::size_t> select_frames(const FrameRange& range, const io::FrameReader& reader) {
  std::int64_t least = reader.index(0);
  std::int64_t most = reader.index(0);
  for (std::size_t i = 0; i < reader.size(); ++i) {
    least = std::min(least, reader.index(i));
    most = std::max(most, reader.index(i));
  }
  const std::int64_t first = range.first.value_or(least);
  const std::int64_t end = range.end.value_or(most + 1);
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < reader.size(); ++i)
    if (reader.index(i) >= first && reader.index(i) < end) selected.push_back(i);
  if (selected.empty() || first < least || end > most + 1)
    throw InputError("--frames " + std::to_string(first) + ":" + std::to_string(end) +
                     ": the recording has the frames " + std::to_string(least) + " to " +
                     std::to_string(most) + ", all of them " + std::to_string(least) + ":" +
                     std::to_string(most + 1));
  return selected;
}

Frame frame_of(const io::FrameData& data) {
  Frame frame;
  frame.stamp = data.stamp;
  frame.depth = data.depth_view();
  frame.joints = data.positions;
  frame.source_status = data.status;
  frame.source_message = data.message;
  frame.index = static_cast<std::size_t>(data.index);
  // A recording's joint row is of the frame's own stamp.
  if (data.stamp && !data.positions.empty()) frame.joints.age = 0;
  return frame;
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

/// Counts the overlays that could not show the recorded colour.
struct ColorFaults {
  std::size_t frames = 0;
  std::string first;

  void add(const std::string& message) {
    if (message.empty()) return;
    if (frames == 0) first = message;
    ++frames;
  }
};

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
std::vector<std::string> notes_of_frames(const SequenceNotes& doubts, const RendererWatch& watch,
                                         const std::string& lost) {
  std::vector<std::string> lines = doubts.lines();
  lines.insert(lines.end(), watch.notes().begin(), watch.notes().end());
  if (!lost.empty()) lines.push_back(lost);
  return lines;
}

std::string more_reasons(const Fault& fault) {
  if (fault.frames == fault.reasons.front().frames) return "";
  return " (other frames for other reasons, see the report)";
}

void tell_faults(const Statistics& statistics, const ColorFaults& color) {
  const auto frames = [&](std::size_t n) {
    return std::to_string(n) + " of " + std::to_string(statistics.frames()) + " frames";
  };
  for (const Fault& fault : statistics.faults())
    std::cerr << "penumbra: " << to_string(fault.status) << " in " << frames(fault.frames)
              << ", first in frame " << fault.reasons.front().first << ": "
              << fault.reasons.front().message << more_reasons(fault) << '\n';
  std::size_t told = 0;
  for (const TargetStatistics& target : statistics.targets())
    if (target.frames(Verdict::unknown) > 0 && ++told <= most_targets)
      std::cerr << "penumbra: target '" << target.name << "' unknown in "
                << frames(target.frames(Verdict::unknown)) << ", first in frame "
                << target.first_unknown << ": " << target.reason << '\n';
  if (told > most_targets)
    std::cerr << "penumbra: " << told - most_targets << " more targets unknown in some frames\n";
  if (color.frames > 0)
    std::cerr << "penumbra: no colour in the overlay of " << frames(color.frames)
              << ", first: " << color.first << '\n';
}

std::string percent(std::size_t part, std::size_t whole) {
  return whole == 0
             ? "-"
             : fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 2) + " %";
}

/// A line for each target; of very many, for the first.
void tell_targets(const Statistics& statistics) {
  const auto& targets = statistics.targets();
  for (const TargetStatistics& target :
       std::span(targets).first(std::min(most_targets, targets.size())))
    std::cout << "target " << target.name << ": " << target.frames(Verdict::visible)
              << " frames visible, " << target.frames(Verdict::partial) << " partial, "
              << target.frames(Verdict::hidden) << " hidden, " << target.frames(Verdict::unknown)
              << " unknown, " << target.frames(Verdict::out_of_view) << " out of view\n";
  if (targets.size() > most_targets)
    std::cout << "and " << targets.size() - most_targets << " more targets, see the report\n";
}

void tell_summary(const Statistics& statistics, const std::filesystem::path& report) {
  const PixelCounts& pixels = statistics.pixels();
  const std::size_t robot = pixels.robot.value_or(0);
  const std::size_t unknown = robot - pixels.front - pixels.occluded - pixels.beyond;
  std::cout << statistics.frames() << " frames, " << statistics.bad_frames() << " bad; of " << robot
            << " robot pixels " << percent(pixels.front, robot) << " front, "
            << percent(pixels.occluded, robot) << " occluded, " << percent(unknown, robot)
            << " unknown, " << percent(pixels.beyond, robot) << " beyond";
  if (pixels.uncovered > 0) std::cout << "; besides " << pixels.uncovered << " uncovered pixels";
  std::cout << '\n';
  tell_targets(statistics);
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (const auto q = statistics.timing(i))
      std::cout << stages[i].name << ": median " << fixed(q->median, 3) << " ms, p99 "
                << fixed(q->p99, 3) << " ms, max " << fixed(q->max, 3) << " ms\n";
  std::cout << "report: " << report.string() << '\n';
}

}  // namespace

int execute(const RunArguments& arguments) {
  check_output(arguments);
  remove_former_run(arguments.output);
  const io::Recording recording = open_recording(arguments);
  Robot robot = Robot::load(recording.urdf, recording.robot);
  tell_notes(robot.notes());
  const io::FrameReader reader(recording, robot);
  const std::vector<std::size_t> selected = select_frames(arguments.frames, reader);
  const Camera camera = camera_of_report(arguments, recording.camera.camera);
  auto targets = open_targets(arguments, recording, robot, camera);
  Pipeline pipeline =
      make_pipeline(arguments, recording, std::move(robot), targets ? targets->history() : 0.0);
  tell_choice(pipeline.renderer_choice());
  const std::vector<std::string> notes = notes_of(pipeline);

  OutputFolder output(arguments.output, arguments.saves, pipeline.rectification());
  UnfinishedRun unfinished(arguments.output);
  io::ReportWriter writer(
      output.report_file(),
      {arguments.input.string(), used_renderer(pipeline, arguments.renderer.backend),
       settings_of(arguments, recording, pipeline, targets), pipeline.robot().links(),
       pipeline.missing_links(), notes});
  Statistics statistics;
  SequenceNotes doubts(pipeline.robot(), {.image = arguments.image});
  ColorFaults color;
  RendererWatch watch(pipeline);
  std::string lost;  // why later frames are not judged
  io::FrameData data;
  try {
    Progress progress(selected.size());
    for (const std::size_t i : selected) {
      reader.read(i, arguments.saves.overlay, data);
      Frame frame = frame_of(data);
      if (targets) frame.targets = targets->of_frame(data.index);
      const FrameReport& report = judge(pipeline, frame, statistics);
      statistics.add(report);
      doubts.add(report, data.positions);
      color.add(data.color_message);
      watch.look(report.index);
      writer.add(report);
      output.save(report, data, {frame.targets, pipeline.robot(), camera});
      progress.step();
    }
  } catch (const DeviceError& error) {
    if (statistics.frames() == 0) throw;
    lost = "frame " + std::to_string(data.index) +
           " and later ones are not judged: " + without_device(error);
  }
  const std::vector<std::string> late_notes = notes_of_frames(doubts, watch, lost);
  writer.finish(statistics, late_notes);
  unfinished.finish();
  tell_faults(statistics, color);
  tell_notes(late_notes);
  tell_summary(statistics, output.report_file());
  if (!lost.empty()) return device_failed;
  return statistics.usable_frames() > 0 ? 0 : 2;
}

}  // namespace penumbra::app
