// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>

#include <penumbra/base/version.hpp>

namespace penumbra::python {
namespace {

/// pybind11 before 2.12 reads the structures of NumPy 1, whichever NumPy is there.
void check_numpy() {
  if constexpr (PYBIND11_VERSION_HEX < 0x020C0000) {
    const auto found = py::cast<std::string>(py::module_::import("numpy").attr("__version__"));
    if (!found.starts_with("1."))
      throw py::import_error("this build of Penumbra works with NumPy 1 only, and NumPy " + found +
                             " is installed: take \"numpy<2\", or build Penumbra with pybind11 "
                             "2.12 or newer, as pip install . does");
  }
}

}  // namespace
}  // namespace penumbra::python

PYBIND11_MODULE(_core, m) {
  using namespace penumbra::python;
  check_numpy();
  m.doc() = "Tells a robot which parts of its view its own body hides.";
  m.attr("__module__") = "penumbra";  // where users find what is defined here
  m.attr("version") = PENUMBRA_VERSION;
  bind_errors(m);
  bind_enums(m);
  bind_camera(m);
  bind_robot(m);
  bind_joint_buffer(m);
  bind_renderer(m);
  bind_labels(m);
  bind_cloud(m);
  bind_trackers(m);
  bind_regions(m);
  bind_targets(m);
  bind_judgement(m);
  bind_robot_pose(m);
  bind_trajectory(m);
  bind_frame(m);
  bind_report(m);
  bind_calibration(m);
  bind_session(m);
  bind_target_fusion(m);
  bind_look_ahead(m);
  bind_targets_file(m);
  bind_input(m);
}
