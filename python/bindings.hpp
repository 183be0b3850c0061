// SPDX-License-Identifier: Apache-2.0
// What every file of the Python module begins with.
#pragma once

#include <memory>
#include <string>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <python/enums.hpp>
#include <python/values.hpp>

namespace penumbra::python {

namespace py = pybind11;

/// Long work that no Python object takes part in lets other threads run.
using WithoutGil = py::call_guard<py::gil_scoped_release>;

/// The object that a method was called on, as Python has it. None, or another's, is a TypeError.
template <typename T>
class Self : public py::object {
  static bool is_one(PyObject* object) { return py::isinstance<T>(object); }
  PYBIND11_OBJECT_DEFAULT(Self, py::object, is_one)
};

// One topic each. Those before are known to those behind: signatures name their types.
void bind_errors(py::module_& m);
void bind_enums(py::module_& m);
void bind_camera(py::module_& m);
void bind_robot(py::module_& m);
void bind_joint_buffer(py::module_& m);
void bind_renderer(py::module_& m);
void bind_labels(py::module_& m);
void bind_cloud(py::module_& m);
void bind_trackers(py::module_& m);
void bind_regions(py::module_& m);
void bind_targets(py::module_& m);
void bind_judgement(py::module_& m);
void bind_robot_pose(py::module_& m);
void bind_trajectory(py::module_& m);
void bind_frame(py::module_& m);
void bind_report(py::module_& m);
void bind_session(py::module_& m);
void bind_target_fusion(py::module_& m);
void bind_look_ahead(py::module_& m);
void bind_targets_file(py::module_& m);
void bind_input(py::module_& m);
void bind_calibration(py::module_& m);

}  // namespace penumbra::python

namespace pybind11::detail {

template <typename T>
struct handle_type_name<penumbra::python::Self<T>> {
  static constexpr auto name = make_caster<T>::name;
};

}  // namespace pybind11::detail
