// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/frame.hpp>
#include <python/robot.hpp>

namespace penumbra::python {

void check_positions(const RobotPose& pose, const Robot& robot) {
  const std::size_t expected = robot.variables().size();
  if (pose.positions.empty() || pose.positions.size() == expected) return;
  throw py::value_error("joints: expected " + std::to_string(expected) +
                        " positions in the order of Robot.variables; got " +
                        std::to_string(pose.positions.size()));
}

void PoseFunction::operator()(std::int64_t stamp, RobotPose& pose) const {
  const py::gil_scoped_acquire gil;
  pose = checked_cast<PoseArgument>(
             function()(stamp),
             "pose_at: expected a penumbra.RobotPose, as pose_of() returns, positions or None")
             .pose;
}

namespace {

RobotPose in_order(const NamedPositions& named, const Robot& robot) {
  for (const auto& [name, position] : named)
    if (!robot.find_variable(name)) throw py::key_error(no_variable(robot, name));
  RobotPose pose;
  for (const std::string& variable : robot.variables()) {
    const auto at = named.find(variable);
    if (at == named.end())
      throw py::key_error("joints: the position of '" + variable + "' is missing");
    pose.positions.push_back(at->second);
  }
  return pose;
}

RobotPose pose_by(const Robot& robot, const Joints& joints) {
  if (const auto* answer = std::get_if<JointAnswer>(&joints)) return pose_of(robot, *answer);
  if (const auto* named = std::get_if<NamedPositions>(&joints)) return in_order(*named, robot);
  const RobotPose& pose = std::get<PoseArgument>(joints).pose;
  check_positions(pose, robot);
  return pose;
}

void bind_attached_body(py::module_& m) {
  using B = AttachedBody;
  py::class_<B> body(m, "AttachedBody",
                     "A thing that a link carries, for example a grasped object or a tool: it "
                     "hides the view as the link does. Make it once and give it to each frame: it "
                     "keeps what was prepared for rendering.");
  body.def(py::init([](std::string name, std::string link, const Mesh& mesh,
                       const Eigen::Isometry3d& pose) {
             return B{std::move(name), std::move(link), mesh.prepared, pose};
           }),
           py::arg("name"), py::arg("link"), py::arg("mesh"), py::arg("T_link_body"),
           "mesh: in the body's frame, metres.");
  show_fields(body, Field{"name", &B::name, "Unique in a frame."},
              Field{"link", &B::link, "That carries it."},
              Field{"T_link_body", &B::T_link_body, "Metres."});
  bind_repr(body, {"name", "link"});
}

}  // namespace

RobotPose known_pose(const Robot& robot, const Joints& joints) {
  RobotPose pose = pose_by(robot, joints);
  const auto variables = robot.variables();
  const bool has_positions = pose.positions.size() == variables.size();
  if (pose.status == FrameStatus::ok && !has_positions && pose.T_root_link.empty())
    throw py::value_error("joints: expected " + std::to_string(variables.size()) +
                          " positions in the order of Robot.variables, or a dict of them by name; "
                          "got none");
  if (std::holds_alternative<JointAnswer>(joints)) return pose;  // says itself what is not known
  for (std::size_t i = 0; i < pose.positions.size(); ++i)
    if (!std::isfinite(pose.positions[i]))
      throw py::value_error("joints: the position of '" + variables[i] + "' is " +
                            std::to_string(pose.positions[i]));
  return pose;
}

void bind_robot_pose(py::module_& m) {
  bind_attached_body(m);
  using P = RobotPose;
  py::class_<P> pose(m, "RobotPose", "The robot's pose at a stamp, and the camera's on it.");
  bind_members(
      pose,
      Field{"positions", &P::positions,
            "Of the joints in the order of Robot.variables, rad and m. Unused if there are poses "
            "of links."},
      Field{"status", &P::status, "Another one than ok: the pose is not known."},
      Field{"message", &P::message, "One line that says why; empty if the status is ok."},
      Field{"age", &P::age,
            "Nanoseconds from the stamp to the farthest joint state used, or None."},
      Field{"T_root_link", &P::T_root_link,
            "Poses of all links, metres, if they are known otherwise than by joints; else empty."},
      Field{"T_parent_camera", &P::T_parent_camera,
            "The camera's pose in its parent link in this frame, metres; None: "
            "Camera.T_parent_camera."},
      Field{"uncertain_links", &P::uncertain_links,
            "Indices of links whose pose is not known: what they could hide is unknown, and "
            "targets in them are not judged."},
      Field{"uncertain_reason", &P::uncertain_reason, "The reason, one line."},
      Field{"attached", &P::attached, "What the robot's links carry."});
  bind_repr(pose, {"status", "positions"});
  m.def("pose_of", &pose_by, py::arg("robot"), py::arg("joints"),
        "Returns the RobotPose of joint positions by name, of what JointBuffer.at() returns, or of "
        "what a Frame takes. Raises KeyError for names that are not those of Robot.variables, and "
        "ValueError for another number of positions.");
}

void bind_frame(py::module_& m) {
  using F = Frame;
  py::class_<F> frame(m, "Frame",
                      "An image or a scan, and all that is needed to judge it: what "
                      "Session.process takes. They are read where they are: do not change them "
                      "while they are judged, nor the depth before points() and without_robot().");
  bind_members<2>(
      frame,
      Field{"depth", &F::depth,
            "Of the camera's size, millimetres (uint16) or metres (float32), 0 = no measurement; "
            "None: no image."},
      Field{"pose", &F::pose,
            "The robot's, at the stamp. As an argument also positions in the order of "
            "Robot.variables, rad and m; None: not known. See pose_of()."},
      Field{"scan", &F::scan, "Of a sensor of points, in place of depth, or None."},
      Field{"pose_at", &F::pose_at,
            "The pose at any stamp during the scan, or up to a bag's image, as pose: a function, "
            "for example lambda stamp: pose_of(robot, joint_buffer.at(stamp)). Session.process "
            "calls it on its own thread, for scans alone. None: pose is that of the whole scan."},
      Field{"stamp", &F::stamp, "Of the depth image or the scan, nanoseconds."},
      Field{"targets", &F::targets, "To be judged."},
      Field{"plan", &F::plan,
            "The motion that the robot follows, or waits to follow; None: none is known. Its "
            "targets' reports then have forecasts."},
      Field{"color", &F::color,
            "Red, green, blue, uint8, for pictures; None: not asked for, not recorded or not "
            "usable."},
      Field{"color_message", &F::color_message,
            "Why a recorded colour image is not usable; empty if it is."},
      Field{"source_status", &F::source_status,
            "A fault of the depth image that its source knows."},
      Field{"source_message", &F::source_message, "One line that describes it."},
      Field{"index", &F::index, "In its source; None: the number of the call."});
  bind_repr(frame, {"index", "stamp", "source_status"});
}

}  // namespace penumbra::python
