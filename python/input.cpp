// SPDX-License-Identifier: Apache-2.0
// What `penumbra run` and `penumbra cloud` take, opened by their own code.
#include <mutex>

#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/frame.hpp>

#include <io/inputs/clouds.hpp>
#include <io/inputs/input_session.hpp>
#include <io/inputs/run_input.hpp>

namespace penumbra::python {
namespace {

/// What `run` or `cloud` judges, as their options say.
struct Input : io::RunInput {
  io::InputOptions options;
  std::vector<std::string> messages;
};

/// The frames of an input, one after the other.
struct Frames {
  explicit Frames(std::shared_ptr<Input> of) : input(std::move(of)), source(input->frames()) {}
  std::shared_ptr<Input> input;
  std::unique_ptr<io::FrameSource> source;
  std::mutex reading;  ///< frames' pose_at read what the source reads
  OneThread thread;
};

/// Reads the next frame, or that with a number. Returns false at the end.
bool read(const std::shared_ptr<Frames>& self, Frame& frame, std::optional<std::size_t> i = {}) {
  {
    const py::gil_scoped_release others;
    const std::lock_guard lock(self->reading);
    if (!(i ? self->source->read(*i, frame) : self->source->next(frame))) return false;
  }
  if (frame.pose_at)
    frame.pose_at = PoseFunction{
        owner_of(py::cpp_function([self, at = std::move(frame.pose_at)](std::int64_t stamp) {
          const py::gil_scoped_release others;
          const std::lock_guard lock(self->reading);
          RobotPose pose;
          at(stamp, pose);
          return pose;
        }))};
  return true;
}

Frame next(const std::shared_ptr<Frames>& self) {
  const OneThread::Use use(self->thread, "the iterator of an Input");
  Frame frame;
  if (!read(self, frame)) throw py::stop_iteration();
  return frame;
}

std::size_t size_of(const std::shared_ptr<Input>& self) {
  const auto size = Frames(self).source->size();
  if (!size)
    throw py::type_error("a bag's number of frames is known at its end: count while iterating");
  return *size;
}

Frame frame_at(const std::shared_ptr<Input>& self, std::size_t i) {
  const auto frames = std::make_shared<Frames>(self);
  Frame frame;
  bool is_there = true;
  if (io::is_bag(self->options.path))  // only forwards
    for (std::size_t number = 0; number <= i && is_there; ++number) is_there = read(frames, frame);
  else
    is_there = read(frames, frame, i);
  if (is_there) return frame;
  throw py::index_error("frame " + std::to_string(i) + ": the input has fewer");
}

/// Opens a camera's images or, where the recording has clouds or `bag` asks for them, a sensor's.
io::RunInput open_one(const io::InputOptions& options, const io::LineSink& print) {
  const bool is_bag = io::is_bag(options.path);
  if (!is_bag) io::check_is_recording(options.path);
  if (!(is_bag ? options.bag.clouds : io::CloudRecording::open(options.path).has_value()))
    return io::open_input(options, print);
  std::vector<io::RunInput> sensors =
      io::open_clouds({.input = options, .rule_changes = {}, .sensor_frame = {}}, print);
  if (sensors.size() == 1) return std::move(sensors.front());
  std::string topics;
  for (const io::RunInput& sensor : sensors) topics += (topics.empty() ? "" : ", ") + sensor.sensor;
  throw InputError(options.path.string() + ": several topics of clouds (" + topics +
                   "); choose one with BagOptions.cloud_topics");
}

io::TargetsFile open_targets(const Input& self, const std::optional<std::filesystem::path>& file,
                             ImageSpace image) {
  if (!file && !self.targets)
    throw InputError(self.options.path.string() + ": has no targets.yaml; give the file");
  return io::open_targets(file ? *file : *self.targets, self, image);
}

/// Returns an input that has a camera.
const Input& with_camera(const Input& self) {
  if (!self.camera)
    throw py::value_error(
        "the input is of a sensor of points and has no camera: Session(robot, cloud)");
  return self;
}

std::shared_ptr<Input> open(const std::filesystem::path& path, bool color,
                            std::optional<Geometry> geometry, bool geometry_fallback,
                            bool allow_missing_meshes,
                            std::optional<std::pair<std::int64_t, std::int64_t>> frames,
                            const std::optional<io::BagOptions>& bag, const std::string& camera,
                            const std::map<std::string, double>& joints) {
  io::InputOptions options{.path = path,
                           .camera = camera,
                           .with_color = color,
                           .geometry = geometry,
                           .geometry_fallback = geometry_fallback,
                           .allow_missing_meshes = allow_missing_meshes,
                           .extra = {},
                           .ignore_links = {},
                           .joints = joints,
                           .frames = {},
                           .fps = {},
                           .bag = bag.value_or(io::BagOptions()),
                           .bag_option = bag ? "bag" : ""};  // a recording folder refuses it
  if (frames) options.frames = {frames->first, frames->second};
  const py::gil_scoped_release others;
  std::vector<std::string> messages;
  const io::LineSink add = [&](const std::string& line) { messages.push_back(line); };
  io::RunInput input = open_one(options, add);
  return std::make_shared<Input>(Input{std::move(input), options, std::move(messages)});
}

void bind_bag_options(py::module_& m) {
  py::class_<io::BagOptions> options(
      m, "BagOptions", "Options for a bag. Topics that are not given are found by type and name.");
  using B = io::BagOptions;
  bind_fields(
      options, Field{"depth_topic", &B::depth_topic, "Depth images."},
      Field{"camera_info_topic", &B::camera_info_topic, "Their camera_info."},
      Field{"color_topic", &B::color_topic, "If given, depth is judged in its image."},
      Field{"clouds", &B::clouds, "Read clouds in place of images."},
      Field{"cloud_topics", &B::cloud_topics, "Which clouds: one topic; none: the only one."},
      Field{"joint_topics", &B::joint_topics, "Joint states."},
      Field{"joint_names", &B::joint_names,
            "Their names of the joints, if they differ: MESSAGE=JOINT with one * on each side, as "
            "left/*=*."},
      Field{"no_depth", &B::no_depth,
            "The camera measures no depth: its colour images are judged by the model alone."},
      Field{"target_topics", &B::target_topics, "Detections, key points, poses."},
      Field{"plan_topics", &B::plan_topics,
            "JointTrajectory that the robot follows; none: MoveIt's display_planned_path."},
      Field{"poses", &B::poses, "None: joints, or transforms if there are no joint states."},
      Field{"robot", &B::robot, "URDF, xacro or MJCF in place of /robot_description."},
      Field{"packages", &B::packages, "package://NAME to its folder."},
      Field{"arguments", &B::arguments, "Of a xacro file: name to value."},
      Field{"frame_prefix", &B::frame_prefix, "Before link names in tf, without a leading /."},
      Field{"camera_frame", &B::camera_frame, "In place of the images' frame_id."},
      Field{"parent", &B::parent, "Link that the camera sits on."},
      Field{"pose", &B::pose, "File of the camera's pose in that link, in place of tf's."},
      Field{"depth_scale", &B::depth_scale,
            "Metres per unit of the depth images; None: 0.001 for integers, 1 for floats."},
      Field{"depth_along_ray", &B::depth_along_ray,
            "Depth is the distance along each pixel's ray, not its z-component."},
      Field{"rectified", &B::rectified, "The images are free of distortion already."},
      Field{"first_publisher", &B::first_publisher,
            "Publishers of one joint are not compared: the first one is believed."},
      Field{"time_offset", &B::time_offset, "Seconds added to an image's stamp."});
}

void bind_input_classes(py::module_& m) {
  py::class_<Frames, std::shared_ptr<Frames>>(m, "InputFrames", "The frames of an Input.")
      .def("__iter__", [](const std::shared_ptr<Frames>& self) { return self; })
      .def("__next__", &next)
      .def_property_readonly(
          "size", [](const Frames& self) { return self.source->size(); },
          "How many there are in all; None: known at the end.")
      .def_property_readonly(
          "notes",
          [](Frames& self) {
            const OneThread::Use use(self.thread, "the iterator of an Input");
            return Frozen<std::string>{self.source->notes()};
          },
          "What was found wrong with the source itself, a line each; all of it is "
          "known at the end.");
  py::class_<Input, std::shared_ptr<Input>> input(
      m, "Input",
      "What `penumbra run` or `penumbra cloud` takes: a recording folder or a ROS 2 bag (*.mcap, "
      "*.db3 or a folder). Iterating reads its frames; each keeps its images, or its scan. The "
      "poses during a bag's scan are known as "
      "long "
      "as it is read in step: judge each frame before you read many more.");
  input
      .def("__iter__",
           [](const std::shared_ptr<Input>& self) { return std::make_shared<Frames>(self); })
      .def("__len__", &size_of)
      .def("__repr__", [](const Input& self) { return "<Input: " + self.robot.name() + ">"; })
      .def("__getitem__", &frame_at, py::arg("i"),
           "Reads a frame, of a bag also those before it. Several threads may use it.")
      .def("open_targets", &open_targets, WithoutGil(),
           py::arg("file") = std::optional<std::filesystem::path>(), py::kw_only(),
           py::arg("image") = ImageSpace::raw,
           "Opens a targets.yaml or a detector's file for these frames; None: the input's own. "
           "image: PipelineConfig.image of their session. Raises InputError with file, line and "
           "key.");
  using I = Input;
  show_properties(
      input, Field{"robot", &I::robot, "The robot."},
      Field{"camera", [](const Input& self) { return *with_camera(self).camera; },
            "Of the judged images."},
      Field{"config", [](const Input& self) { return with_camera(self).config; },
            "Defaults of a session with the input's own settings."},
      Field{
          "cloud",
          [](const Input& self) { return self.camera ? std::nullopt : std::optional(self.cloud); },
          "Of a sensor of points, in place of camera and config; else None."},
      Field{"targets", &I::targets, "The input's own targets.yaml, or None."},
      Field{"target_history", &I::target_history,
            "PipelineConfig.target_history for targets that come with the frames, s."},
      Field{"beyond", &I::beyond, "What verdicts make of beyond; None: it does not say."},
      Field{"messages", &I::messages, "Which topics and poses of a bag are used, a line each."});
}

}  // namespace

void bind_input(py::module_& m) {
  bind_bag_options(m);
  bind_input_classes(m);
  const io::InputOptions defaults;
  m.def("open", &open, py::arg("path"), py::kw_only(), py::arg("color") = defaults.with_color,
        py::arg("geometry") = defaults.geometry,
        py::arg("geometry_fallback") = defaults.geometry_fallback,
        py::arg("allow_missing_meshes") = defaults.allow_missing_meshes,
        py::arg("frames") = std::optional<std::pair<std::int64_t, std::int64_t>>(),
        py::arg("bag") = std::optional<io::BagOptions>(), py::arg("camera") = defaults.camera,
        py::arg("joints") = std::map<std::string, double>(),
        "Opens what `penumbra run` or `penumbra cloud` takes, as their options of these names say. "
        "color: read colour images, too (of a camera without depth some are, to diagnose the "
        "setup); frames: (first, end) of those wanted; bag: of bags alone; camera: which one, "
        "of a recording with several; joints: positions at which joints are held, rad or m. "
        "Raises InputError that names the file.");
}

}  // namespace penumbra::python
