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

Frame OwnedFrame::view(const Robot& robot, Parts& parts) const {
  Frame frame;
  frame.stamp = stamp;
  if (depth) frame.depth = depth->view;
  if (const auto* positions = std::get_if<Numbers>(&joints)) {
    frame.joints = positions->values;
    frame.joints.age = joint_age;
  } else if (const auto* named = std::get_if<NamedPositions>(&joints)) {
    parts.positions = in_order(*named, robot);
    frame.joints = parts.positions;
    frame.joints.age = joint_age;
  } else if (const auto* answer = std::get_if<JointAnswer>(&joints)) {
    frame.joints = *answer;
  }
  frame.T_root_link = T_root_link;
  frame.T_parent_camera = T_parent_camera;
  if (const auto* own = std::get_if<0>(&targets)) {
    for (const auto& target : *own) parts.targets.push_back(target_of(target));
    frame.targets = parts.targets;
  } else {
    frame.targets = std::get<1>(targets).targets();
  }
  frame.source_status = source_status;
  frame.source_message = source_message;
  frame.index = index;
  frame.doubts = {doubted_links, doubt};
  return frame;
}

namespace {

OwnedFrame make_frame(std::optional<DepthArgument<"depth">> depth, OwnedJoints joints,
                      std::optional<std::int64_t> stamp, OwnedTargets targets,
                      std::optional<Poses> T_root_link,
                      std::optional<Eigen::Isometry3d> T_parent_camera, FrameStatus source_status,
                      std::string source_message, std::optional<std::size_t> index,
                      std::optional<std::int64_t> joint_age, std::vector<std::size_t> doubted_links,
                      std::string doubt) {
  return {std::move(depth),
          std::move(joints),
          joint_age,
          stamp,
          std::move(T_root_link).value_or(Poses()),
          T_parent_camera,
          std::move(targets),
          source_status,
          std::move(source_message),
          index,
          std::move(doubted_links),
          std::move(doubt)};
}

const std::vector<const char*>& arguments() {
  static const std::vector<const char*> names{
      "depth",         "joints",         "stamp", "targets",   "T_root_link",   "T_parent_camera",
      "source_status", "source_message", "index", "joint_age", "doubted_links", "doubt"};
  return names;
}

using FrameClass = py::class_<OwnedFrame>;

void bind_constructor(FrameClass& frame) {
  const Frame defaults;
  frame.def(
      py::init(&make_frame), py::arg("depth"), py::arg("joints"), py::kw_only(),
      py::arg("stamp") = defaults.stamp, py::arg("targets") = OwnedTargets(),
      py::arg("T_root_link") = std::optional<Poses>(),
      py::arg("T_parent_camera") = defaults.T_parent_camera,
      py::arg("source_status") = defaults.source_status, py::arg("source_message") = std::string(),
      py::arg("index") = defaults.index, py::arg("joint_age") = std::optional<std::int64_t>(),
      py::arg("doubted_links") = std::vector<std::size_t>(), py::arg("doubt") = std::string(),
      "depth: of the camera's size, millimetres (uint16) or metres (float32), 0 = no "
      "measurement; None: there is none. joints: a dict of positions by name, or an array in the "
      "order "
      "of Robot.variables, rad and m, or what JointBuffer.at() says; None: not known. stamp: of "
      "the depth image, "
      "nanoseconds. T_root_link: poses of the links, metres, that are known otherwise than by "
      "joints. T_parent_camera: the camera's pose in its parent link in this frame; None: the "
      "configuration's. source_status, source_message: what is known to be wrong with the frame. "
      "joint_age: of positions, nanoseconds. doubted_links, doubt: indices of links that are not "
      "drawn and whose place is not known, and one line that says why: targets and estimates in "
      "them are not judged.");
}

void bind_values(FrameClass& frame) {
  using F = OwnedFrame;
  frame
      .def_property_readonly(
          "depth",
          [](const F& f) -> std::optional<ImageResult<std::uint16_t, float>> {
            if (!f.depth) return std::nullopt;
            return ImageResult<std::uint16_t, float>{f.depth->array};
          },
          "The array itself.")
      .def_property_readonly(
          "joints", [](const F& f) { return f.joints; }, "As they were given.")
      .def_property_readonly(
          "stamp", [](const F& f) { return f.stamp; }, "Nanoseconds.")
      .def_property_readonly(
          "targets", [](const F& f) { return f.targets; }, "To be judged.")
      .def_property_readonly(
          "T_root_link",
          [](const F& f) -> std::optional<Poses> {
            if (f.T_root_link.empty()) return std::nullopt;
            return f.T_root_link;
          },
          "Metres; None: by joints.")
      .def_property_readonly(
          "T_parent_camera", [](const F& f) { return f.T_parent_camera; },
          "Metres; None: the configuration's.")
      .def_property_readonly(
          "source_status", [](const F& f) { return f.source_status; },
          "What its source knows to be wrong.")
      .def_property_readonly(
          "source_message", [](const F& f) { return f.source_message; }, "One line that says so.")
      .def_property_readonly(
          "index", [](const F& f) { return f.index; }, "In its source.")
      .def_property_readonly(
          "joint_age", [](const F& f) { return f.joint_age; }, "Nanoseconds.")
      .def_property_readonly(
          "doubted_links", [](const F& f) { return f.doubted_links; },
          "Indices of links whose place is not known.")
      .def_property_readonly(
          "doubt", [](const F& f) { return f.doubt; }, "One line that says why.");
}

}  // namespace

void bind_frame(py::module_& m) {
  FrameClass frame(
      m, "Frame",
      "What goes into Pipeline.process. The depth image is looked at where it lies: do "
      "not change it while it is judged.");
  bind_constructor(frame);
  bind_values(frame);
  bind_replace(frame, arguments());
  frame.def("__repr__", [](const Self<OwnedFrame>& self) {
    return repr_of(self, {"index", "stamp", "source_status"});
  });
}

}  // namespace penumbra::python
