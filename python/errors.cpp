// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include <python/bindings.hpp>

#include <penumbra/base/error.hpp>

namespace penumbra::python {
namespace {

/// Lives as long as the process: translators may be called until its end.
PyObject* make_exception(py::module_& m, const char* name, const char* doc, PyObject* base) {
  const std::string full = std::string("penumbra.") + name;
  PyObject* const type = PyErr_NewExceptionWithDoc(full.c_str(), doc, base, nullptr);
  if (type == nullptr) throw py::error_already_set();
  m.attr(name) = py::handle(type);
  return type;
}

PyObject* input_error = nullptr;
PyObject* device_error = nullptr;

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    PyErr_SetString(input_error, error.what());
  } catch (const DeviceError& error) {
    PyErr_SetString(device_error, error.what());
  }
}

}  // namespace

void bind_errors(py::module_& m) {
  input_error = make_exception(m, "InputError",
                               "The user's input is at fault. One line names the file, the "
                               "element, what is wrong and what would be right.",
                               PyExc_ValueError);
  device_error = make_exception(m, "DeviceError",
                                "The graphics device failed. Nothing that it was to draw is to be "
                                "trusted; make a new renderer or pipeline.",
                                PyExc_RuntimeError);
  py::register_exception_translator(&translate);
}

}  // namespace penumbra::python
