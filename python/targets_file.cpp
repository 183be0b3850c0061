// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>

#include <io/files/targets_file.hpp>

namespace penumbra::python {

namespace {

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

}  // namespace

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

}  // namespace penumbra::python
