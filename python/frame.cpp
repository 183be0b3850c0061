// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/frame.hpp>
#include <python/robot.hpp>

namespace penumbra::python {

namespace {

std::vector<double> in_order(const NamedPositions& named, const Robot& robot) {
  for (const auto& [name, position] : named)
    if (!robot.find_variable(name)) throw py::key_error(no_variable(robot, name));
  std::vector<double> positions;
  for (const std::string& variable : robot.variables()) {
    const auto at = named.find(variable);
    if (at == named.end())
      throw py::key_error("joints: the position of '" + variable + "' is missing");
    positions.push_back(at->second);
  }
  return positions;
}

}  // namespace

Frame OwnedFrame::view(const Robot& robot) const {
  Frame frame;
  frame.stamp = stamp;
  if (depth) frame.depth = depth->view;
  RobotPose& pose = frame.pose;
  if (const auto* positions = std::get_if<Numbers>(&joints)) {
    const std::size_t expected = robot.variables().size();
    if (positions->values.size() != expected)
      throw py::value_error("joints: expected " + std::to_string(expected) +
                            " positions in the order of Robot.variables; got " +
                            std::to_string(positions->values.size()));
    pose.positions = positions->values;
    pose.age = joint_age;
  } else if (const auto* named = std::get_if<NamedPositions>(&joints)) {
    pose.positions = in_order(*named, robot);
    pose.age = joint_age;
  } else if (const auto* answer = std::get_if<JointAnswer>(&joints)) {
    pose = pose_of(robot, *answer);
  }
  if (T_root_link) pose.T_root_link = *T_root_link;
  pose.T_parent_camera = T_parent_camera;
  pose.uncertain_links.insert(pose.uncertain_links.end(), uncertain_links.begin(),
                              uncertain_links.end());
  if (!uncertain_reason.empty()) pose.uncertain_reason = uncertain_reason;
  pose.attached = attached;
  frame.targets = targets;
  if (plan) frame.plan = plan->trajectory;
  frame.source_status = source_status;
  frame.source_message = source_message;
  frame.index = index;
  return frame;
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

void bind_frame(py::module_& m) {
  bind_attached_body(m);
  py::class_<PlannedMotion>(
      m, "Trajectory",
      "A planned motion. Between two points it is linear, with velocities cubic, "
      "with accelerations, too, quintic.");
  using F = OwnedFrame;
  py::class_<F> frame(m, "Frame",
                      "What goes into Pipeline.process. The depth image is read where it is: do "
                      "not change it while it is judged.");
  bind_members<2>(
      frame,
      Field{"depth", &F::depth,
            "Of the camera's size, millimetres (uint16) or metres (float32), 0 = no measurement; "
            "None: no image."},
      Field{"joints", &F::joints,
            "A dict of positions by name, or an array in the order of Robot.variables, rad and m, "
            "or what JointBuffer.at() returns; None: not known."},
      Field{"stamp", &F::stamp, "Of the depth image, nanoseconds."},
      Field{"targets", &F::targets, "To be judged."},
      Field{
          "T_root_link", &F::T_root_link,
          "Poses of the links, metres, that are known otherwise than by joints; None: by joints."},
      Field{"T_parent_camera", &F::T_parent_camera,
            "The camera's pose in its parent link in this frame, metres; None: the "
            "configuration's."},
      Field{"source_status", &F::source_status, "What its source knows to be wrong with it."},
      Field{"source_message", &F::source_message, "One line that describes it."},
      Field{"index", &F::index, "In its source."},
      Field{"joint_age", &F::joint_age, "Of positions, nanoseconds."},
      Field{"uncertain_links", &F::uncertain_links,
            "Indices of links whose pose is not known: what they could hide is unknown, and "
            "targets in "
            "them are not judged."},
      Field{"uncertain_reason", &F::uncertain_reason, "The reason, one line."},
      Field{"attached", &F::attached, "What the robot's links carry."},
      Field{"plan", &F::plan,
            "The Trajectory that the robot follows, or waits to follow; None: none is known. Its "
            "targets' reports then have forecasts."});
  bind_repr(frame, {"index", "stamp", "source_status"});
  frame.def(
      "positions",
      [](const F& self, const Robot& robot) {
        Frame view = self.view(robot);
        const bool known = view.pose.status == FrameStatus::ok && !view.pose.positions.empty();
        return known ? std::optional(Numbers{std::move(view.pose.positions)}) : std::nullopt;
      },
      py::arg("robot"),
      "Its joints in the order of Robot.variables; None: not known. Raises as Pipeline.process.");
}

}  // namespace penumbra::python
