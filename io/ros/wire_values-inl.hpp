// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>

namespace penumbra::io {

// Messages that stand for one value of ours, and how they are converted.

struct TimeWire {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

struct Vector2Wire {
  double x = 0, y = 0;
};

/// Point and Vector3 have equal fields, but two names.
template <bool is_point>
struct TripleWire {
  double x = 0, y = 0, z = 0;
};
using PointWire = TripleWire<true>;
using Vector3Wire = TripleWire<false>;

struct QuaternionWire {
  double x = 0, y = 0, z = 0, w = 1;
};

struct TransformWire {
  Vector3Wire translation;
  QuaternionWire rotation;
};

struct PoseWire {
  PointWire position;
  QuaternionWire orientation;
};

inline constexpr std::int64_t nanoseconds_of_second = 1'000'000'000;

// from_wire answers what is wrong, or nullptr.

[[nodiscard]] inline const char* from_wire(const TimeWire& wire, std::int64_t& stamp) {
  stamp = std::int64_t{wire.sec} * nanoseconds_of_second + wire.nanosec;
  return wire.nanosec < nanoseconds_of_second ? nullptr : "its nanoseconds exceed a second";
}

inline void to_wire(std::int64_t stamp, TimeWire& wire) {
  std::int64_t seconds = stamp / nanoseconds_of_second;
  std::int64_t rest = stamp % nanoseconds_of_second;
  if (rest < 0) {
    rest += nanoseconds_of_second;
    --seconds;
  }
  using Seconds = std::numeric_limits<std::int32_t>;
  if (seconds < Seconds::min() || seconds > Seconds::max())
    throw InputError("stamp " + std::to_string(stamp) +
                     " ns cannot be written: ROS 2 has 32 bits for seconds");
  wire = {static_cast<std::int32_t>(seconds), static_cast<std::uint32_t>(rest)};
}

[[nodiscard]] inline const char* from_wire(const Vector2Wire& wire, Eigen::Vector2d& vector) {
  vector = {wire.x, wire.y};
  return nullptr;
}

template <bool is_point>
[[nodiscard]] const char* from_wire(const TripleWire<is_point>& wire, Eigen::Vector3d& vector) {
  vector = {wire.x, wire.y, wire.z};
  return nullptr;
}

template <bool is_point>
void to_wire(const Eigen::Vector3d& vector, TripleWire<is_point>& wire) {
  wire = {vector.x(), vector.y(), vector.z()};
}

[[nodiscard]] inline const char* from_wire(const QuaternionWire& wire, Eigen::Vector4d& vector) {
  vector = {wire.x, wire.y, wire.z, wire.w};
  return nullptr;
}

inline void to_wire(const Eigen::Vector4d& vector, QuaternionWire& wire) {
  wire = {vector[0], vector[1], vector[2], vector[3]};
}

template <bool is_point>
[[nodiscard]] Eigen::Isometry3d isometry_of(const TripleWire<is_point>& at,
                                            const QuaternionWire& q) {
  constexpr double most_off_unit = 0.01;  // tf2's, of the squared length
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(at.x, at.y, at.z);
  if (std::abs(rotation.squaredNorm() - 1) < most_off_unit)
    pose.linear() = rotation.normalized().toRotationMatrix();
  else
    pose.linear().setConstant(std::numeric_limits<double>::quiet_NaN());
  return pose;
}

template <bool is_point>
void isometry_to(const Eigen::Isometry3d& pose, TripleWire<is_point>& at, QuaternionWire& q) {
  to_wire(Eigen::Vector3d(pose.translation()), at);
  const Eigen::Quaterniond rotation(pose.linear());
  const double sign = rotation.w() < 0 ? -1 : 1;
  to_wire(Eigen::Vector4d(sign * rotation.coeffs()), q);
}

[[nodiscard]] inline const char* from_wire(const TransformWire& wire, Eigen::Isometry3d& pose) {
  pose = isometry_of(wire.translation, wire.rotation);
  return nullptr;
}

inline void to_wire(const Eigen::Isometry3d& pose, TransformWire& wire) {
  isometry_to(pose, wire.translation, wire.rotation);
}

[[nodiscard]] inline const char* from_wire(const PoseWire& wire, Eigen::Isometry3d& pose) {
  pose = isometry_of(wire.position, wire.orientation);
  return nullptr;
}

inline void to_wire(const Eigen::Isometry3d& pose, PoseWire& wire) {
  isometry_to(pose, wire.position, wire.orientation);
}

}  // namespace penumbra::io
