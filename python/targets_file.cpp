// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>

#include <io/files/targets_file.hpp>

namespace penumbra::python {

void bind_targets_file(py::module_& m) {
  py::class_<io::TargetsFile>(m, "TargetsFile",
                              "A targets.yaml or a detector's file (docs/targets.md): which "
                              "targets each frame has. Input.open_targets() opens one.")
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
