// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/frame.hpp>
#include <python/report.hpp>
#include <python/robot.hpp>

namespace penumbra::python {
namespace {

using State = SessionState;

void bind_pipeline_settings(py::module_& m) {
  py::class_<PipelineConfig> config(m, "PipelineConfig", "How frames are judged.");
  using C = PipelineConfig;
  bind_fields(
      config, Field{"backend", &C::backend, "What draws."},
      Field{"renderer", &C::renderer, "How the backend draws."},
      Field{"rule", &C::rule, "Its range and the camera's both apply."},
      Field{"image", &C::image, "Which image results are given in."},
      Field{"has_depth", &C::has_depth,
            "False: the camera measures no depth. Verdicts come from the robot's model alone."},
      Field{"target_history", &C::target_history,
            "Seconds that frames are kept for targets of an earlier stamp; 0: not at all."});
}

template <typename... Of>
std::shared_ptr<State> make_session(const RobotArgument& robot, const Of&... of) {
  const py::gil_scoped_release others;
  return std::make_shared<State>(robot.robot(), of...);
}

Report process(const std::shared_ptr<State>& self, const Frame& frame) {
  const OneThread::Use use(self->thread, "Session.process");
  std::visit(
      [&](const auto& depth) {
        if (const auto& size = self->depth_size; size && !depth.empty())
          check_size("depth", depth.width, depth.height, size->width(), size->height());
      },
      frame.depth.view);
  check_positions(frame.pose, self->session.pipeline().robot());
  ++self->calls;
  const FrameReport* report = nullptr;
  {
    const py::gil_scoped_release others;
    report = &self->session.process(frame);
  }
  return {self, *report, frame.depth.owner};
}

Report process_depth(const std::shared_ptr<State>& self, const SharedDepth& depth,
                     const Joints& joints, Nanoseconds<std::optional<std::int64_t>> stamp,
                     std::vector<Target> targets) {
  return process(self, {.stamp = stamp,
                        .depth = depth,
                        .pose = known_pose(self->session.pipeline().robot(), joints),
                        .targets = std::move(targets)});
}

using Mask = Shown<"Annotated[NDArray[bool_], '(H, W)']">;

Mask mask_of(const RobotArgument& given, const Camera& camera, const Joints& joints) {
  const Robot robot = given.robot();
  const RobotPose pose = known_pose(robot, joints);
  Image<std::uint8_t> mask;
  {
    const py::gil_scoped_release others;
    mask = robot_mask(robot, camera, pose);
  }
  return array_of(std::as_const(mask).view(), nullptr).array.attr("__ne__")(0);
}

AttachedBody attach_target(State& self, const Target& target, const std::string& link) {
  const OneThread::Use use(self.thread, "Session.attach_target");
  return self.session.pipeline().attach_target(target, link);
}

void forget(State& self, const std::string& name) {
  const OneThread::Use use(self.thread, "Session.forget_target");
  self.session.pipeline().forget_target(name);
}

void begin_sequence(State& self) {
  const OneThread::Use use(self.thread, "Session.begin_sequence");
  self.session.begin_sequence();
}

Frozen<std::string> warnings(State& self) {
  const OneThread::Use use(self.thread, "Session.warnings");
  const auto of_robot = self.session.pipeline().robot().notes();
  Frozen<std::string> lines{{of_robot.begin(), of_robot.end()}};
  for (auto& line : self.session.warnings()) lines.values.push_back(line);
  return lines;
}

}  // namespace

void bind_session(py::module_& m) {
  bind_pipeline_settings(m);
  py::class_<State, std::shared_ptr<State>> session(
      m, "Session",
      "The whole method, one call per frame: poses, virtual depth, labels, targets. Serves one "
      "thread at a time; other threads run meanwhile.");
  session
      .def(py::init(&make_session<Camera, PipelineConfig>), py::arg("robot"), py::arg("camera"),
           py::arg("config") = PipelineConfig(),
           "Raises InputError for a robot without geometry, a camera parent that is no link, a "
           "pose that is not rigid, and what the parts refuse.")
      .def(py::init(&make_session<CloudConfig>), py::arg("robot"), py::arg("config"),
           "With a CloudConfig it is of a sensor of points, and its frames have scans.")
      .def(
          "process", &process_depth, py::arg("depth"), py::arg("joints"), py::kw_only(),
          py::arg("stamp") = py::none(), py::arg("targets") = std::vector<Target>(),
          "Judges a depth image: as a Frame, but unknown joints are an error. joints: positions by "
          "name, or in the order of Robot.variables, rad and m. Raises KeyError for a name that is "
          "missing or unknown, and ValueError for another number of positions, or one that is not "
          "finite.")
      .def("process", &process, py::arg("frame"),
           "Judges one frame. Whatever is wrong with it is the report's status. Raises ValueError "
           "for a depth image of another size than the camera's and for another number of joint "
           "positions than the robot has, what Frame.pose_at raises, DeviceError if a graphics "
           "device fails.")
      .def("attach_target", &attach_target, py::arg("target"), py::arg("link"),
           "Returns a target of the last frame as the AttachedBody that `link` carries from that "
           "frame on: a BoxTarget, MeshTarget or PointTarget (its ball). Call it when the gripper "
           "closes, and give the body to the following frames. Its pose is the target's handled "
           "pose or, without handling, the pose of its shape. Raises InputError if that pose, the "
           "link's or the robot's is not known, and for a target that was not in the last frame or "
           "is no 3-D shape.")
      .def("forget_target", &forget, py::arg("name"),
           "Forgets a target's verdict, extent and track: the name stands for something new.")
      .def("begin_sequence", &begin_sequence,
           "Forgets all targets, the kept frames and the warnings: a new sequence begins.")
      .def("warnings", &warnings,
           "What is doubtful of the robot and of the frames so far, a line each, as `penumbra run` "
           "prints it: for example, degrees for radians or millimetres for metres.");
  session.def(
      "diagnosis",
      [](State& s) {
        const OneThread::Use use(s.thread, "Session.diagnosis");
        return s.session.diagnosis();
      },
      "What is wrong with the setup, by the frames so far: the camera's pose, its intrinsics, the "
      "depth's unit, the joint positions. Takes a tenth of a second, or about a second if "
      "something "
      "looks wrong.");
  session.def_property_readonly(
      "drift", [](const State& s) { return s.session.drift(); },
      "How far the camera has moved from its calibration, by the frames so far.");
  const auto of = [](auto member) {
    return [member](const State& s) { return std::invoke(member, s.session.pipeline()); };
  };
  using P = Pipeline;
  show_fields(
      session, Field{"robot", of(&P::robot), "The robot."},
      Field{"missing_links", of(&P::missing_links), "Links whose geometry could not be read."});
  m.def("robot_mask", &mask_of, py::arg("robot"), py::arg("camera"), py::arg("joints"),
        "Returns where a camera sees the robot if nothing stands before it: bool (H, W), in the "
        "camera's own image; False where its lens model does not reach. robot: a Robot, or the "
        "path of its description; joints: as of Session.process. For many images use "
        "Session.process and "
        "FrameReport.robot_mask. Raises InputError if the mask would lack something: the camera's "
        "pose is not known, a mesh could not be read, or a part is within 1 cm of the camera.");
  show_properties(session,
                  Field{"renderer", of(&P::renderer),
                        "What draws. Of a camera, as the next three: RuntimeError for scans."},
                  Field{"triangle_count", of(&P::triangle_count), "Of all links."},
                  Field{"rule", of(&P::rule), "The rule that labels are made by."},
                  Field{"intrinsics", of(&P::intrinsics), "Size and projection of report images."});
}

}  // namespace penumbra::python
