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

/// Makes a source's depth image the frame's own.
template <typename T>
void take_depth(io::FrameData& data, ImageView<const T> view) {
  if (view.empty()) return;
  if (const auto* own = std::get_if<Image<T>>(&data.depth); own && own->data() == view.data) return;
  Image<T> copy(view.width, view.height);
  for (int v = 0; v < view.height; ++v) std::copy_n(view.row(v), view.width, copy.view().row(v));
  data.depth = std::move(copy);
}

std::optional<DepthArgument<"depth">> depth_of(const std::shared_ptr<io::FrameData>& data) {
  return std::visit(
      [&](auto& image) -> std::optional<DepthArgument<"depth">> {
        if (image.empty()) return std::nullopt;
        using Pixel = std::remove_pointer_t<decltype(image.data())>;
        return DepthArgument<"depth">{array_of(image.view(), data).array,
                                      ImageView<const Pixel>(image.view())};
      },
      data->depth);
}

OwnedJoints joints_of(const JointInput& joints) {
  if (joints.status == JointStatus::ok)
    return Numbers{{joints.positions.begin(), joints.positions.end()}};
  if (joints.status == JointStatus::missing && joints.gaps.empty()) return std::monostate();
  JointAnswer answer;
  answer.status = joints.status;
  answer.age = joints.age.value_or(0);
  answer.positions.assign(joints.positions.begin(), joints.positions.end());
  answer.gaps.assign(joints.gaps.begin(), joints.gaps.end());
  answer.disputes.assign(joints.disputes.begin(), joints.disputes.end());
  return answer;
}

}  // namespace

RecordedFrame recorded(std::shared_ptr<io::FrameData> data, const Frame& frame,
                       OwnedTargets targets) {
  std::visit([&](const auto& view) { take_depth(*data, view); }, frame.depth);
  OwnedFrame owned{.depth = depth_of(data),
                   .joints = joints_of(frame.joints),
                   .stamp = frame.stamp,
                   .targets = std::move(targets),
                   .T_root_link = {},
                   .T_parent_camera = frame.T_parent_camera,
                   .source_status = frame.source_status,
                   .source_message = std::string(frame.source_message),
                   .index = frame.index,
                   .joint_age = frame.joints.age,
                   .uncertain_links = {frame.uncertain_links.begin(), frame.uncertain_links.end()},
                   .uncertain_reason = std::string(frame.uncertain_reason),
                   .attached = {frame.attached.begin(), frame.attached.end()}};
  if (!frame.T_root_link.empty())
    owned.T_root_link.emplace(frame.T_root_link.begin(), frame.T_root_link.end());
  return {std::move(data), std::move(owned)};
}

namespace {

void bind_description(py::module_& m) {
  py::class_<io::RecordingCamera> camera(m, "RecordingCamera", "The camera of a recording.");
  using C = io::RecordingCamera;
  show_fields(camera, Field{"info", &C::info, "The camera_info file."},
              Field{"camera", &C::camera, "What its images are like."},
              Field{"rectified", &C::rectified, "The images are free of distortion already."},
              Field{"parent", &C::parent, "The link that the camera sits on."},
              Field{"T_parent_camera", &C::T_parent_camera,
                    "Pose of the optical frame in the parent link, metres; None: not known."},
              Field{"range", &C::range, "None: not written there."},
              Field{"tolerance", &C::tolerance, "None: not written there."},
              Field{"front_min_width", &C::front_min_width, "Pixels; None: not written there."},
              Field{"fringe_reach", &C::fringe_reach, "Pixels; None: not written there."},
              Field{"sensor", &C::sensor, "Name of a kind of sensor; None: not written there."},
              Field{"beyond", &C::beyond, "None: not written there."});
  py::class_<io::Recording> recording(m, "Recording",
                                      "A recording folder's description, read and checked.");
  using R = io::Recording;
  recording
      .def_static(
          "open", &R::open, py::arg("folder_or_yaml"), py::arg("camera") = "", WithoutGil(),
          "Reads a recording.yaml, or the one in a folder. Raises InputError with file, line "
          "and key.")
      .def("pipeline_config", &R::pipeline_config,
           "The defaults of a pipeline with the recording's settings.");
  show_fields(recording, Field{"file", &R::file, "The recording.yaml."},
              Field{"urdf", &R::urdf, "The robot's file."},
              Field{"robot", &R::robot, "How it is read."},
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
  auto data = std::make_shared<io::FrameData>();
  {
    const py::gil_scoped_release others;
    self.reader.read(at, self.color, *data);
  }
  return recorded(data, io::frame_of(*data), {});
}

void bind_recorded_frames(py::module_& m) {
  using F = RecordedFrame;
  py::class_<F> frame(m, "RecordedFrame", "A recorded frame. Its images stay as they are.");
  const auto of = [](auto member) { return [member](const F& f) { return (*f.data).*member; }; };
  using D = io::FrameData;
  show_properties(
      frame, Field{"frame", &F::frame, "What Pipeline.process takes."},
      Field{"index", of(&D::index), "Its number."}, Field{"stamp", of(&D::stamp), "Nanoseconds."},
      Field{"status", of(&D::status), "What is wrong with its data."},
      Field{"message", of(&D::message), "One line that names the file; empty if ok."},
      Field{"depth", [](const F& f) { return f.frame.depth; },
            "Millimetres (uint16) or metres (float32), 0 = no measurement; None: no image."},
      Field{"color",
            [](const F& f) {
              return f.data->color.empty() ? std::nullopt
                                           : std::optional(array_of(f.data->color.view(), f.data));
            },
            "Red, green, blue; None: not asked for, not recorded or not usable."},
      Field{"color_message", of(&D::color_message),
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

/// The targets of a file, and whose are given out.
struct Targets : TargetSource {
  explicit Targets(io::TargetsFile file_) : file(std::move(file_)) {}
  io::TargetsFile file;
};

std::shared_ptr<Targets> open_targets(const std::filesystem::path& file, const Robot& robot,
                                      ImageSpace image, const Intrinsics& images, bool is_bent,
                                      bool beyond_hides, double history,
                                      const std::string& camera_frame) {
  const py::gil_scoped_release others;
  return std::make_shared<Targets>(io::TargetsFile::open(file, {.robot = robot,
                                                                .image = image,
                                                                .images = images,
                                                                .is_bent = is_bent,
                                                                .beyond_hides = beyond_hides,
                                                                .history = history,
                                                                .camera_frame = camera_frame}));
}

SourceTargets targets_of(const std::shared_ptr<Targets>& self, std::int64_t index) {
  const OneThread::Use use(self->thread, "TargetsFile.of_frame");
  ++self->given;
  return {self, self->file.of_frame(index)};
}

void bind_targets_file(py::module_& m) {
  py::class_<Targets, std::shared_ptr<Targets>>(m, "TargetsFile",
                                                "A targets.yaml (docs/targets.md): which targets "
                                                "each frame has.")
      .def_static(
          "open", &open_targets, py::arg("file"), py::kw_only(), py::arg("robot"), py::arg("image"),
          py::arg("images"), py::arg("is_bent"), py::arg("beyond_hides"),
          py::arg("history") = io::TargetsContext::default_history,
          py::arg("camera_frame") = std::string(),
          "robot: whose links may be named; image: of the report; images: size and "
          "projection of the report's images; is_bent: the camera's raw images have lens "
          "distortion; beyond_hides: of targets that do not say it; history: seconds that "
          "frames are kept for late targets, if there are any; camera_frame: of the report's "
          "images. Raises InputError with file, line and key.")
      .def("of_frame", &targets_of, py::arg("index"),
           "All of the file's targets as they are in that frame, until the next call.")
      .def("__len__", [](const Targets& self) { return self.file.size(); })
      .def_property_readonly(
          "history", [](const Targets& self) { return self.file.history(); },
          "PipelineConfig.target_history that they need, seconds.");
}

}  // namespace

void bind_recording(py::module_& m) {
  bind_description(m);
  bind_recorded_frames(m);
  bind_targets_file(m);
}

}  // namespace penumbra::python
