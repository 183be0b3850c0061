// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <io/files/trajectory_file.hpp>
#include <io/inputs/look_ahead_input.hpp>
#include <io/inputs/planning_input.hpp>

namespace penumbra::io {
namespace {

constexpr double least_jump = 0.01;  // rad or m: what a robot at rest may differ by

/// The first frame whose joint positions are known, and which has a plan where no file gives one;
/// or the given one.
Frame find_frame(FrameSource& source, const Robot& robot, const LookAheadOptions& options) {
  Frame frame;
  std::string fault;
  bool is_known = false;
  while (source.next(frame)) {
    is_known =
        has_pose(frame.pose.status) && frame.pose.positions.size() == robot.variables().size();
    if (is_known && (frame.plan || !options.trajectories.empty())) return frame;
    if (is_known || !fault.empty()) continue;
    fault = "; frame " + std::to_string(frame.index.value_or(0)) + ": " +
            (frame.pose.message.empty() && !frame.pose.T_root_link.empty() ? "poses come from TF"
                                                                           : frame.pose.message);
  }
  if (is_known)
    throw InputError(options.input.path.string() + ": has no planned motion" +
                     (options.from ? " in or before this frame" : "") +
                     "; give one with --trajectory, or its topic with --plan-topic");
  throw InputError(options.input.path.string() + ": " +
                   (options.from ? "the robot's joint positions are not known in frame " +
                                       std::to_string(*options.from)
                                 : "the robot's joint positions are known in no frame") +
                   fault);
}

ForecastCamera camera_of(const RunInput& input, const RobotPose& pose, std::string name) {
  ForecastCamera camera{
      .name = std::move(name), .camera = *input.camera, .rule = input.config.rule};
  if (pose.T_parent_camera) camera.camera.T_parent_camera = pose.T_parent_camera;
  return camera;
}

/// Adds what the camera measures of the targets in the frame.
void judge(const RunInput& input, Frame frame, LookAheadInput& to) {
  for (Target& target : frame.targets) target.handling = {};
  Pipeline pipeline(to.robot, *input.camera, input.config);
  const FrameReport& report = pipeline.process(frame);
  if (has_depth(report.status)) to.now = {report.targets.begin(), report.targets.end()};
}

void add(NamedTrajectory motion, LookAheadInput& to) {
  if (const Trajectory::Jump jump = motion.trajectory.jump(); jump.by > least_jump) {
    std::ostringstream note;
    note << motion.name << ": begins " << jump.by << " rad or m from where '"
         << to.robot.variables()[jump.variable] << "' is in frame " << to.frame
         << ": the robot is elsewhere than the plan assumes";
    to.notes.push_back(note.str());
  }
  for (const std::string& line : motion.trajectory.notes())
    to.notes.push_back(motion.name + ": " + line);
  to.trajectories.push_back(std::move(motion));
}

void add_trajectories(const std::filesystem::path& file, LookAheadInput& to) {
  for (FileTrajectory& read : read_trajectories(file)) try {
      add({read.name,
           Trajectory(to.robot, read.variables, std::move(read.points), to.pose.positions)},
          to);
    } catch (const InputError& fault) {
      throw InputError(file.string() + ": " + fault.what());
    }
}

}  // namespace

LookAheadInput read_look_ahead_input(const LookAheadOptions& options, const LineSink& print) {
  InputOptions input = options.input;
  input.with_color = true;
  if (options.from) input.frames = {*options.from, *options.from + 1, "--from"};
  std::vector<std::string> names = cameras_of(input.path);
  if (names.empty() || !input.camera.empty()) names = {input.camera};
  std::optional<LookAheadInput> read;
  for (const std::string& name : names) {
    input.camera = name;
    const RunInput opened = open_input(input, print);
    const auto source = opened.frames();
    Frame frame = find_frame(*source, opened.robot, options);
    if (!read) {
      read = LookAheadInput{
          .robot = opened.robot, .frame = frame.index.value_or(0), .pose = frame.pose};
      if (frame.plan && options.trajectories.empty())
        add({"the planned motion", *frame.plan}, *read);
      const TargetsFile targets = open_planned_targets(options.input.path, options.targets, opened);
      frame.targets = targets.of_frame(static_cast<std::int64_t>(read->frame));
      for (const Target& target : frame.targets) read->targets.push_back({.target = target});
      const ImageView<const Rgb8> color = frame.color.view;
      if (!color.empty()) {
        read->color = Image<Rgb8>(color.width, color.height);
        for (int v = 0; v < color.height; ++v)
          std::copy_n(color.row(v), color.width, read->color.view().row(v));
      }
      // Frames by number, so that each camera's is of the same time.
      input.frames = {static_cast<std::int64_t>(read->frame),
                      static_cast<std::int64_t>(read->frame) + 1};
      judge(opened, frame, *read);
    }
    read->cameras.push_back(camera_of(opened, frame.pose, name));
  }
  for (const std::filesystem::path& file : options.trajectories) add_trajectories(file, *read);
  return std::move(*read);
}

}  // namespace penumbra::io
