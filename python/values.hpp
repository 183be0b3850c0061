// SPDX-License-Identifier: Apache-2.0
// Points, rotations and poses between Eigen and NumPy. They are values: copied both ways, so any
// array of real numbers of the right shape will do; what comes out cannot be written to.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <pybind11/numpy.h>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::python {

namespace py = pybind11;

/// A text as a template's parameter.
template <std::size_t N>
struct Name {
  char text[N]{};
  constexpr Name(const char (&from)[N]) { std::copy_n(from, N, text); }  // NOLINT
};

/// Any object. Signatures show its type as `Type`.
template <Name Type>
class Shown : public py::object {
  static bool is_any(PyObject* object) { return object != nullptr; }
  PYBIND11_OBJECT_DEFAULT(Shown, py::object, is_any)
};

/// Poses as an array of shape (N, 4, 4).
using Poses = std::vector<Eigen::Isometry3d>;

/// Points as an array of shape (N, 3).
using Points = std::vector<Eigen::Vector3d>;

/// Numbers as an array of shape (N,).
using Numbers = std::vector<double>;

/// Returns an array on the memory of what exports DLPack, as PyTorch and JAX do, and anything else
/// as it is. Throws TypeError for memory that NumPy cannot use, as a GPU's.
[[nodiscard]] py::object as_array(py::handle source);

/// Whether it is an array with a mask (numpy.ma's), which no conversion would keep.
[[nodiscard]] bool is_masked(py::handle object);

/// What is wrong with one: behind what was expected, and what came.
inline constexpr const char* mask_fault = ": its mask would be lost: take .filled(value)";

/// An array of float64 of that shape in C order; -1 stands for any extent. Throws TypeError for
/// what holds no real numbers, or is masked, and ValueError for another shape; `what` says what
/// they are.
[[nodiscard]] py::array_t<double> numbers_of(py::handle source, std::span<const py::ssize_t> shape,
                                             const char* what);

/// An array that owns a copy of the numbers and cannot be written to.
[[nodiscard]] py::array copied(std::span<const double> values, std::vector<py::ssize_t> shape);

[[nodiscard]] Eigen::Isometry3d pose_of(py::handle source);
[[nodiscard]] Poses poses_of(py::handle source);
[[nodiscard]] Points point_rows_of(py::handle source);
[[nodiscard]] Numbers vector_of(py::handle source);
[[nodiscard]] py::array array_of(const Eigen::Isometry3d& pose);
[[nodiscard]] py::array array_of(const Poses& poses);
[[nodiscard]] py::array array_of(const Points& points);
[[nodiscard]] py::array array_of(const Numbers& numbers);

/// A vector or matrix whose size is known.
template <typename M>
[[nodiscard]] M matrix_of(py::handle source) {
  constexpr int rows = M::RowsAtCompileTime, columns = M::ColsAtCompileTime;
  const std::string what =
      columns == 1 ? std::to_string(rows) + " numbers"
                   : std::to_string(rows) + " x " + std::to_string(columns) + " numbers";
  std::vector<py::ssize_t> shape{rows};
  if (columns != 1) shape.push_back(columns);
  const auto array = numbers_of(source, shape, what.c_str());
  M matrix;
  for (int i = 0; i < rows * columns; ++i) matrix(i / columns, i % columns) = array.data()[i];
  return matrix;
}

template <typename M>
[[nodiscard]] py::array array_of_matrix(const M& matrix) {
  std::vector<double> values;
  for (int i = 0; i < matrix.rows(); ++i)
    for (int j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  std::vector<py::ssize_t> shape{matrix.rows()};
  if (matrix.cols() != 1) shape.push_back(matrix.cols());
  return copied(values, std::move(shape));
}

/// The plumbing of a caster whose value is made by one function and shown by another.
template <typename T>
struct ValueCaster {
  T value{};
  template <typename U>
  using cast_op_type = py::detail::movable_cast_op_type<U>;
  operator T*() { return &value; }                // NOLINT(google-explicit-constructor)
  operator T&() { return value; }                 // NOLINT(google-explicit-constructor)
  operator T&&() && { return std::move(value); }  // NOLINT(google-explicit-constructor)
};

/// A value that is copied from and to an array.
template <typename T, T (*from)(py::handle), py::array (*to)(const T&)>
struct ArrayCaster : ValueCaster<T> {
  bool load(py::handle source, bool /*convert*/) {
    if (source.is_none()) return false;
    this->value = from(source);
    return true;
  }
  static py::handle cast(const T& value, py::return_value_policy /*policy*/,
                         py::handle /*parent*/) {
    return to(value).release();
  }
};

}  // namespace penumbra::python

namespace pybind11::detail {

template <penumbra::python::Name Type>
struct handle_type_name<penumbra::python::Shown<Type>> {
  static constexpr auto name = const_name(Type.text);
};

template <penumbra::python::Name Type>
struct pyobject_caster<penumbra::python::Shown<Type>> {
  using Object = penumbra::python::Shown<Type>;
  bool load(handle source, bool /*convert*/) {
    value = reinterpret_steal<Object>(penumbra::python::as_array(source).release());
    return true;
  }
  static handle cast(const handle& of, return_value_policy /*policy*/, handle /*parent*/) {
    return of.inc_ref();
  }
  PYBIND11_TYPE_CASTER(Object, handle_type_name<Object>::name);
};

template <int rows, int columns, int options>
struct type_caster<Eigen::Matrix<double, rows, columns, options, rows, columns>>
    : penumbra::python::ArrayCaster<
          Eigen::Matrix<double, rows, columns, options, rows, columns>,
          &penumbra::python::matrix_of<
              Eigen::Matrix<double, rows, columns, options, rows, columns>>,
          &penumbra::python::array_of_matrix<
              Eigen::Matrix<double, rows, columns, options, rows, columns>>> {
  static constexpr auto name =
      const_name("Annotated[NDArray[float64], '(") + const_name<rows>() + const_name(",") +
      const_name<columns == 1>(const_name(""), const_name(" ") + const_name<columns>()) +
      const_name(")']");
};
template <>
struct type_caster<Eigen::Isometry3d>
    : penumbra::python::ArrayCaster<Eigen::Isometry3d, &penumbra::python::pose_of,
                                    &penumbra::python::array_of> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(4, 4)']");
};
template <>
struct type_caster<penumbra::python::Poses>
    : penumbra::python::ArrayCaster<penumbra::python::Poses, &penumbra::python::poses_of,
                                    &penumbra::python::array_of> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(N, 4, 4)']");
};
template <>
struct type_caster<penumbra::python::Points>
    : penumbra::python::ArrayCaster<penumbra::python::Points, &penumbra::python::point_rows_of,
                                    &penumbra::python::array_of> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(N, 3)']");
};
template <>
struct type_caster<penumbra::python::Numbers>
    : penumbra::python::ArrayCaster<penumbra::python::Numbers, &penumbra::python::vector_of,
                                    &penumbra::python::array_of> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(N,)']");
};

/// In the order x, y, z, w.
template <>
struct type_caster<Eigen::Quaterniond> : penumbra::python::ValueCaster<Eigen::Quaterniond> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(4,) x y z w']");
  static handle cast(const Eigen::Quaterniond& q, return_value_policy /*policy*/,
                     handle /*parent*/) {
    return penumbra::python::array_of_matrix(q.coeffs()).release();
  }
};

}  // namespace pybind11::detail
