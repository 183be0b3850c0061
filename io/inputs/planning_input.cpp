// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>

#include <io/files/candidates_file.hpp>
#include <io/inputs/input_session.hpp>
#include <io/inputs/planning_input.hpp>

namespace penumbra::io {

TargetsFile open_planned_targets(const std::filesystem::path& path,
                                 const std::optional<std::filesystem::path>& given,
                                 const RunInput& input) {
  const auto& file = given ? given : input.targets;
  if (!file) throw InputError(path.string() + ": has no targets; give a file with --targets");
  TargetsFile targets = open_targets(*file, input, ImageSpace::raw);
  if (targets.size() == 0) throw InputError(file->string() + ": has no targets");
  return targets;
}

namespace {

std::vector<Target> placed(std::vector<Target> targets, const Eigen::Isometry3d& T_root_camera,
                           const std::filesystem::path& file) {
  for (Target& target : targets) {
    target.fault = {};  // its shape is then std::monostate: not found
    target.estimate.reset();
    if (std::holds_alternative<std::monostate>(target.shape)) continue;
    const auto at = placement_of(target.shape);
    if (!at)
      throw InputError(file.string() + ": target '" + target.name +
                       "' is given in pixels of the input's camera; other cameras need a point, "
                       "box3d or mesh");
    if (at->frame.kind == ReferenceFrame::Kind::camera)
      penumbra::place(target.shape, {T_root_camera * at->pose, ReferenceFrame::root()});
  }
  return targets;
}

/// Returns why the robot's pose is not known in a frame; empty if it is. Depth is not needed.
std::string why_without_pose(const RobotPose& pose, const Robot& robot) {
  if (!has_pose(pose.status))
    return pose.message.empty() ? std::string(to_string(pose.status)) : pose.message;
  const bool has_joints = pose.positions.size() == robot.variables().size();
  return has_joints || !pose.T_root_link.empty() ? "" : "its joint states are missing or stale";
}

}  // namespace

PlanningInput read_planning_input(const PlanningOptions& options, const LineSink& print,
                                  const std::function<void()>& step) {
  RunInput opened = open_input(options.input, print);
  TargetsFile targets = open_planned_targets(options.input.path, options.targets, opened);
  std::vector<ForecastCamera> candidates =
      read_candidates(options.candidates, opened.robot,
                      {.name = {}, .camera = *opened.camera, .rule = opened.config.rule});
  PlanningInput read{.input = std::move(opened),
                     .targets = std::move(targets),
                     .candidates = std::move(candidates),
                     .motion = {},
                     .notes = {}};
  const Robot& robot = read.input.robot;
  const Camera& camera = *read.input.camera;
  const std::size_t parent = find_camera_parent(robot, camera.parent);
  const auto source = read.input.frames();
  Frame frame;
  std::string fault;
  while (source->next(frame)) {
    const std::size_t index = frame.index.value_or(read.seen);
    ++read.seen;
    step();
    if (const std::string why = why_without_pose(frame.pose, robot); !why.empty()) {
      if (fault.empty()) fault = "frame " + std::to_string(index) + ": " + why;
      continue;
    }
    Frame& kept = read.motion.emplace_back();
    kept.index = index;
    std::vector<Eigen::Isometry3d>& T_root_link = kept.pose.T_root_link = frame.pose.T_root_link;
    if (T_root_link.empty()) {
      T_root_link.resize(robot.links().size());
      robot.forward_kinematics(frame.pose.positions, T_root_link);
    }
    kept.pose.attached = frame.pose.attached;
    kept.pose.uncertain_links = frame.pose.uncertain_links;
    const Eigen::Isometry3d T_root_camera =
        T_root_link[parent] * frame.pose.T_parent_camera.value_or(camera.pose());
    kept.targets = placed(read.targets.of_frame(static_cast<std::int64_t>(index)), T_root_camera,
                          read.targets.file());
  }
  read.notes = source->notes();
  if (read.motion.empty())
    throw InputError(options.input.path.string() + ": the robot's pose is known in no frame" +
                     (fault.empty() ? "" : "; " + fault));
  if (!fault.empty())
    read.notes.push_back(std::to_string(read.seen - read.motion.size()) + " of " +
                         std::to_string(read.seen) +
                         " frames are left out, because the robot's pose is not known; the first "
                         "is " +
                         fault);
  return read;
}

}  // namespace penumbra::io
