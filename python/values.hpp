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

#include <penumbra/tracking/pose_tracker.hpp>

namespace penumbra::python {

namespace py = pybind11;

/// Poses as an array of shape (N, 4, 4).
using Poses = std::vector<Eigen::Isometry3d>;

/// Numbers as an array of shape (N,).
struct Numbers {
  std::vector<double> values;
};

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
[[nodiscard]] std::vector<double> vector_of(py::handle source);
[[nodiscard]] py::array array_of(const Eigen::Isometry3d& pose);

/// An array of shape (N, 4, 4) upon the poses themselves, which it keeps.
[[nodiscard]] py::array array_of(Poses poses);

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

template <typename M>
struct MatrixCaster : ValueCaster<M> {
  bool load(py::handle source, bool /*convert*/) {
    if (source.is_none()) return false;
    this->value = matrix_of<M>(source);
    return true;
  }
  static py::handle cast(const M& matrix, py::return_value_policy /*policy*/,
                         py::handle /*parent*/) {
    return array_of_matrix(matrix).release();
  }
};

}  // namespace penumbra::python

namespace pybind11::detail {

template <>
struct type_caster<Eigen::Vector2d> : penumbra::python::MatrixCaster<Eigen::Vector2d> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(2,)']");
};
template <>
struct type_caster<Eigen::Vector3d> : penumbra::python::MatrixCaster<Eigen::Vector3d> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(3,)']");
};
template <>
struct type_caster<Eigen::Matrix3d> : penumbra::python::MatrixCaster<Eigen::Matrix3d> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(3, 3)']");
};
template <>
struct type_caster<penumbra::Vector6d> : penumbra::python::MatrixCaster<penumbra::Vector6d> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(6,)']");
};
template <>
struct type_caster<penumbra::Matrix6d> : penumbra::python::MatrixCaster<penumbra::Matrix6d> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(6, 6)']");
};

template <>
struct type_caster<Eigen::Isometry3d> : penumbra::python::ValueCaster<Eigen::Isometry3d> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(4, 4)']");
  bool load(handle source, bool /*convert*/) {
    if (source.is_none()) return false;
    value = penumbra::python::pose_of(source);
    return true;
  }
  static handle cast(const Eigen::Isometry3d& pose, return_value_policy /*policy*/,
                     handle /*parent*/) {
    return penumbra::python::array_of(pose).release();
  }
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

template <>
struct type_caster<penumbra::python::Poses>
    : penumbra::python::ValueCaster<penumbra::python::Poses> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(N, 4, 4)']");
  bool load(handle source, bool /*convert*/) {
    if (source.is_none()) return false;
    value = penumbra::python::poses_of(source);
    return true;
  }
  static handle cast(penumbra::python::Poses poses, return_value_policy /*policy*/,
                     handle /*parent*/) {
    return penumbra::python::array_of(std::move(poses)).release();
  }
};

template <>
struct type_caster<penumbra::python::Numbers>
    : penumbra::python::ValueCaster<penumbra::python::Numbers> {
  static constexpr auto name = const_name("Annotated[NDArray[float64], '(N,)']");
  bool load(handle source, bool /*convert*/) {
    if (source.is_none()) return false;
    value.values = penumbra::python::vector_of(source);
    return true;
  }
  static handle cast(const penumbra::python::Numbers& numbers, return_value_policy /*policy*/,
                     handle /*parent*/) {
    const auto size = static_cast<ssize_t>(numbers.values.size());
    return penumbra::python::copied(numbers.values, {size}).release();
  }
};

}  // namespace pybind11::detail
