// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <python/bindings.hpp>

#include <penumbra/base/version.hpp>

namespace {

namespace py = pybind11;

PyObject* refuse_new(PyObject* /*self*/, PyObject* /*args*/, PyObject* /*kwargs*/) {
  PyErr_SetString(PyExc_TypeError,
                  "__new__ alone makes no object of penumbra: expected a call of the class");
  return nullptr;
}

// The detour tells GCC that the cast is meant.
PyMethodDef refusing = {"__new__",
                        reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&refuse_new)),
                        METH_VARARGS | METH_KEYWORDS, nullptr};

/// No object without its C++ one: pybind11 would hand out memory that nothing was written to.
void seal(const py::module_& m) {
  for (const auto& [name, value] : m.attr("__dict__").cast<py::dict>()) {
    const bool is_ours =
        py::isinstance<py::type>(value) &&
        py::type::of(value).attr("__name__").cast<std::string>() == "pybind11_type";
    if (!is_ours) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(value.ptr());
    const newfunc made_by = type->tp_new;
    const auto refuse = py::reinterpret_steal<py::object>(PyCFunction_New(&refusing, nullptr));
    py::setattr(value, "__new__", py::staticmethod(refuse));
    type->tp_new = made_by;  // what calls of the class use
    type->tp_flags &= ~static_cast<unsigned long>(Py_TPFLAGS_BASETYPE);
    PyType_Modified(type);
  }
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  using namespace penumbra::python;
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
  bind_trackers(m);
  bind_regions(m);
  bind_targets(m);
  bind_judgement(m);
  bind_frame(m);
  bind_report(m);
  bind_pipeline(m);
  bind_recording(m);
  bind_input(m);
  seal(m);
}
