// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/recording.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>
#include <io/files/targets_file.hpp>

namespace penumbra::python {

namespace {

std::optional<DepthArgument<"depth">> depth_of(const SharedDepth& depth) {
  if (is_empty(depth.view)) return std::nullopt;
  return std::visit(
      [&]<typename T>(ImageView<const T> view) {
        const py::array array = array_of(view, depth.owner).array;
        const ImageView<const T> kept{static_cast<const T*>(array.data()), view.width, view.height,
                                      array.strides(0) / static_cast<py::ssize_t>(sizeof(T))};
        return DepthArgument<"depth">{array, kept};
      },
      depth.view);
}

}  // namespace

RecordedFrame recorded(Frame frame) {
  RobotPose& pose = frame.pose;
  OwnedFrame owned{.depth = depth_of(frame.depth),
                   .joints = {},
                   .stamp = frame.stamp,
                   .targets = std::move(frame.targets),
                   .T_root_link = {},
                   .T_parent_camera = pose.T_parent_camera,
                   .source_status = std::max(pose.status, frame.source_status),
                   .source_message = pose.message,
                   .index = frame.index,
                   .joint_age = pose.age,
                   .uncertain_links = std::move(pose.uncertain_links),
                   .uncertain_reason = std::move(pose.uncertain_reason),
                   .attached = std::move(pose.attached)};
  if (!owned.source_message.empty() && !frame.source_message.empty()) owned.source_message += "; ";
  owned.source_message += frame.source_message;
  if (!pose.T_root_link.empty())
    owned.T_root_link = std::move(pose.T_root_link);
  else if (pose.status == FrameStatus::ok)
    owned.joints = Numbers{std::move(pose.positions)};
  return {std::move(owned), frame.color, std::move(frame.color_message)};
}

namespace {

void bind_description(py::module_& m) {
  py::class_<io::RecordingCamera> camera(m, "RecordingCamera", "The camera of a recording.");
  using C = io::RecordingCamera;
  const auto given = [](const auto& setting) {
    return [setting](const C& c) {
      const auto value = c.rule.values.*setting.member;
      return c.rule.given.contains(setting.name) ? std::optional(value) : std::nullopt;
    };
  };
  std::apply(
      [&](const auto&... setting) {
        show_fields(
            camera, Field{"info", &C::info, "The camera_info file."},
            Field{"camera", &C::camera, "What its images are like."},
            Field{"rectified", &C::rectified, "The images are free of distortion already."},
            Field{"parent", &C::parent, "The link that the camera sits on."},
            Field{"T_parent_camera", &C::T_parent_camera,
                  "Pose of the optical frame in the parent link, metres; None: not known."},
            Field{"range", &C::range, "None: not written there."},
            Field{setting.name, given(setting), "Of LabelRule; None: not written there."}...,
            Field{"sensor", [](const C& c) { return c.rule.sensor; },
                  "Name of a kind of sensor; None: not written there."},
            Field{"beyond", &C::beyond, "None: not written there."});
      },
      LabelRule::settings());
  py::class_<io::Recording> recording(m, "Recording",
                                      "A recording folder's description, read and checked.");
  using R = io::Recording;
  recording
      .def_static(
          "open", &R::open, py::arg("folder_or_yaml"), py::arg("camera") = "", WithoutGil(),
          "Reads a recording.yaml, or the one in a folder. Raises InputError with file, line "
          "and key.")
      .def("load_robot", &R::load_robot, WithoutGil(),
           "Loads the robot, or joins the robots. Raises InputError.")
      .def("pipeline_config", &R::pipeline_config,
           "The defaults of a pipeline with the recording's settings.");
  show_fields(recording, Field{"file", &R::file, "The recording.yaml."},
              Field{"camera", &R::camera, "Its camera."},
              Field{"targets", &R::targets, "The targets.yaml, or None."});
}

/// A reader of frames, each into images of its own.
struct Reader {
  Reader(const io::Recording& recording, const Robot& robot, bool color_)
      : reader(recording, robot), color(color_) {}
  io::FrameReader reader;
  bool color;
};

RecordedFrame read(const Reader& self, std::ptrdiff_t i) {
  const auto size = static_cast<std::ptrdiff_t>(self.reader.size());
  if (i < -size || i >= size)
    throw py::index_error("frame: expected an index in " + std::to_string(-size) + ".." +
                          std::to_string(size - 1) + "; got " + std::to_string(i));
  const auto at = static_cast<std::size_t>(i < 0 ? i + size : i);
  Frame frame;
  {
    const py::gil_scoped_release others;
    frame = self.reader.read(at, self.color);
  }
  return recorded(std::move(frame));
}

void bind_recorded_frames(py::module_& m) {
  using F = RecordedFrame;
  py::class_<F> frame(m, "RecordedFrame", "A recorded frame. Its images stay as they are.");
  const auto of = [](auto member) { return [member](const F& f) { return f.frame.*member; }; };
  using O = OwnedFrame;
  show_properties(
      frame, Field{"frame", &F::frame, "What Pipeline.process takes."},
      Field{"index", [](const F& f) { return f.frame.index.value(); }, "Its number."},
      Field{"stamp", of(&O::stamp), "Nanoseconds."},
      Field{"status", of(&O::source_status), "What is wrong with its data."},
      Field{"message", of(&O::source_message), "One line that names the file; empty if ok."},
      Field{"depth", of(&O::depth),
            "Millimetres (uint16) or metres (float32), 0 = no measurement; None: no image."},
      Field{"color",
            [](const F& f) {
              return f.color.view.empty() ? std::nullopt
                                          : std::optional(array_of(f.color.view, f.color.owner));
            },
            "Red, green, blue; None: not asked for, not recorded or not usable."},
      Field{"color_message", &F::color_message,
            "Why a recorded colour image is not usable; empty if it is."});
  bind_repr(frame, {"index", "stamp", "status", "message"});
  py::class_<Reader, std::shared_ptr<Reader>>(
      m, "FrameReader",
      "A recording's frames, in the order of the joint file: len(), [i], iteration. Several "
      "threads may use it; other threads run while a frame is read.")
      .def(py::init([](const io::Recording& recording, const Robot& robot, bool color) {
             const py::gil_scoped_release others;
             return std::make_shared<Reader>(recording, robot, color);
           }),
           py::arg("recording"), py::arg("robot"), py::kw_only(), py::arg("color"),
           "color: read colour images, too. Raises InputError for an invalid joint file.")
      .def("__len__", [](const Reader& self) { return self.reader.size(); })
      .def("__getitem__", &read, py::arg("i"))
      .def("__repr__",
           [](const Reader& self) {
             return "<penumbra.FrameReader: " + std::to_string(self.reader.size()) + " frames>";
           })
      .def("__iter__", [](const Self<Reader>& self) {
        return py::reinterpret_steal<FrameIterator>(PySeqIter_New(self.ptr()));
      });
}

io::TargetsFile open_targets(const std::filesystem::path& file, const Robot& robot,
                             ImageSpace image, const Intrinsics& images, bool has_distortion,
                             bool beyond_hides, double history, const std::string& camera_frame) {
  return io::TargetsFile::open(file, {.robot = robot,
                                      .image = image,
                                      .images = images,
                                      .has_distortion = has_distortion,
                                      .beyond_hides = beyond_hides,
                                      .history = history,
                                      .camera_frame = camera_frame});
}

void bind_targets_file(py::module_& m) {
  py::class_<io::TargetsFile>(m, "TargetsFile",
                              "A targets.yaml (docs/targets.md): which targets "
                              "each frame has.")
      .def_static(
          "open", &open_targets, WithoutGil(), py::arg("file"), py::kw_only(), py::arg("robot"),
          py::arg("image"), py::arg("images"), py::arg("has_distortion"), py::arg("beyond_hides"),
          py::arg("history") = io::TargetsContext::default_history,
          py::arg("camera_frame") = std::string(),
          "robot: whose links may be named; image: of the report; images: size and "
          "projection of the report's images; has_distortion: the camera's raw images have lens "
          "distortion; beyond_hides: of targets that do not say it; history: seconds that "
          "frames are kept for late targets, if there are any; camera_frame: of the report's "
          "images. Raises InputError with file, line and key.")
      .def(
          "of_frame",
          [](const io::TargetsFile& self, std::int64_t i) {
            return Frozen<Target>{self.of_frame(i)};
          },
          py::arg("index"), "All of the file's targets as they are in that frame.")
      .def(
          "check_frames",
          [](io::TargetsFile& self, const std::vector<std::int64_t>& frames) {
            self.check_frames(frames);
          },
          py::arg("frames"),
          "Compares the detections' frames with those of the recording, ascending. Raises "
          "InputError if none is of these, or all are only if they are moved by one.")
      .def_property_readonly(
          "notes", [](const io::TargetsFile& self) { return Frozen<std::string>{self.notes()}; },
          "What is doubtful about the detections, a line each.")
      .def("__len__", &io::TargetsFile::size)
      .def_property_readonly("history", &io::TargetsFile::history,
                             "PipelineConfig.target_history that they need, seconds.");
}

using PngSource = Shown<"Annotated[Union[NDArray[uint8], NDArray[uint16]], '(H, W) or (H, W, 3)']">;

void write_png(const std::filesystem::path& file, const PngSource& image) {
  static constexpr PixelType types[] = {pixel_type<std::uint8_t>, pixel_type<std::uint16_t>};
  const auto given = py::reinterpret_borrow<py::array>(image);
  const bool is_color = py::isinstance<py::array>(image) && given.ndim() == 3 &&
                        given.shape(2) == 3 && given.size() > 0;
  const py::array rows = is_color ? py::array(image.attr("reshape")(given.shape(0), -1)) : given;
  const std::size_t type = check_image(rows, "image", std::span(types).first(is_color ? 1 : 2));
  const py::gil_scoped_release others;
  if (type == 1) return io::write_png(file, view_of<std::uint16_t>(rows));
  const ImageView<const std::uint8_t> view = view_of<std::uint8_t>(rows);
  if (!is_color) return io::write_png(file, view);
  const auto* const pixels = reinterpret_cast<const Rgb8*>(view.data);
  io::write_png(file, ImageView<const Rgb8>{pixels, view.width / 3, view.height, view.stride / 3});
}

}  // namespace

void bind_recording(py::module_& m) {
  bind_description(m);
  bind_recorded_frames(m);
  bind_targets_file(m);
  m.def("write_png", &write_png, py::arg("file"), py::arg("image"),
        "Writes uint8 or uint16 as grey, uint8 (H, W, 3) as red, green, blue. Raises InputError if "
        "the file cannot be written.");
}

}  // namespace penumbra::python
