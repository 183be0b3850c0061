// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <python/arrays.hpp>
#include <python/bindings.hpp>

namespace penumbra::python {
namespace {

std::string shape_text(std::span<const py::ssize_t> shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i == 0 ? "" : ", ") + (shape[i] < 0 ? std::string("N") : std::to_string(shape[i]));
  return text + (shape.size() == 1 ? ",)" : ")");
}

bool fits(const py::array& array, std::span<const py::ssize_t> shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape[i] >= 0 && array.shape(static_cast<py::ssize_t>(i)) != shape[i]) return false;
  return true;
}

Eigen::Isometry3d pose_at(const double* rows) {
  Eigen::Isometry3d pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows);
  if (pose.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw py::value_error("expected a pose whose last row is 0 0 0 1");
  return pose;
}

}  // namespace

py::object as_array(py::handle source) {
  auto object = py::reinterpret_borrow<py::object>(source);
  if (py::isinstance<py::array>(source) || !py::hasattr(source, "__dlpack__")) return object;
  try {
    return py::module_::import("numpy").attr("from_dlpack")(object);
  } catch (py::error_already_set& error) {
    throw py::type_error("NumPy cannot use the memory of a " + description_of(source) + " (" +
                         py::cast<std::string>(py::str(error.value())) +
                         "): copy it to the CPU, for a tensor of PyTorch by .detach().cpu()");
  }
}

bool is_masked(py::handle object) {
  const auto* const plain = py::detail::npy_api::get().PyArray_Type_;
  return Py_TYPE(object.ptr()) != plain && py::isinstance<py::array>(object) &&
         py::hasattr(object, "mask");
}

py::array_t<double> numbers_of(py::handle given, std::span<const py::ssize_t> shape,
                               const char* what) {
  const py::object source = as_array(given);
  const auto expected = [&] {
    return std::string("expected ") + what + ", an array of float64 with shape " +
           shape_text(shape);
  };
  if (is_masked(source))
    throw py::type_error(expected() + "; got " + description_of(source) + mask_fault);
  // Without forcecast: what is no real number, or would lose digits, is refused.
  using Exact = py::array_t<double, py::array::c_style>;
  PyObject* const made = py::detail::npy_api::get().PyArray_FromAny_(
      source.ptr(), py::dtype::of<double>().release().ptr(), 0, 0,
      py::detail::npy_api::NPY_ARRAY_ENSUREARRAY_ | int{py::array::c_style}, nullptr);
  if (made == nullptr) {
    PyErr_Clear();
    throw py::type_error(expected() + "; got " + description_of(source));
  }
  auto array = py::reinterpret_steal<Exact>(made);
  if (!fits(array, shape)) throw py::value_error(expected() + "; got " + description_of(array));
  return array;
}

py::array copied(std::span<const double> values, std::vector<py::ssize_t> shape) {
  py::array_t<double> array(std::move(shape));
  std::copy(values.begin(), values.end(), array.mutable_data());
  return read_only(std::move(array));
}

Eigen::Isometry3d pose_of(py::handle source) {
  constexpr py::ssize_t shape[] = {4, 4};
  return pose_at(numbers_of(source, shape, "a pose").data());
}

Poses poses_of(py::handle source) {
  constexpr py::ssize_t shape[] = {-1, 4, 4};
  const auto array = numbers_of(source, shape, "poses");
  Poses poses;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) poses.push_back(pose_at(array.data() + 16 * i));
  return poses;
}

Points point_rows_of(py::handle source) {
  constexpr py::ssize_t shape[] = {-1, 3};
  const auto array = numbers_of(source, shape, "points");
  Points points(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Eigen::Map<const Eigen::Vector3d>(array.data() + 3 * i);
  return points;
}

Numbers vector_of(py::handle source) {
  constexpr py::ssize_t shape[] = {-1};
  const auto array = numbers_of(source, shape, "numbers");
  return {array.data(), array.data() + array.size()};
}

py::array array_of(const Eigen::Isometry3d& pose) { return array_of_matrix(pose.matrix()); }

py::array array_of(const Points& points) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return copied({points.empty() ? nullptr : points[0].data(), 3 * points.size()},
                {static_cast<py::ssize_t>(points.size()), 3});
}

py::array array_of(const Numbers& numbers) {
  return copied(numbers, {static_cast<py::ssize_t>(numbers.size())});
}

py::array array_of(const Poses& poses) {
  const auto count = static_cast<py::ssize_t>(poses.size());
  constexpr auto number = static_cast<py::ssize_t>(sizeof(double));
  // Eigen's matrices lie by columns. Without a base the array is a copy.
  return read_only(py::array(py::dtype::of<double>(), {count, py::ssize_t{4}, py::ssize_t{4}},
                             {16 * number, number, 4 * number}, poses.data()));
}

}  // namespace penumbra::python
