// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

// Messages that are converted to one value of ours.

struct TimeWire {
  static constexpr std::string_view ros_type = "builtin_interfaces/Time";
  static auto layout(auto& m) { return fields_of(m.sec, m.nanosec); }

  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

struct Vector2Wire {
  static constexpr std::string_view ros_type = "vision_msgs/Point2D";
  static auto layout(auto& m) { return fields_of(m.x, m.y); }

  double x = 0, y = 0;
};

struct Vector3Wire {
  static constexpr std::string_view ros_type = "geometry_msgs/Vector3";
  static auto layout(auto& m) { return fields_of(m.x, m.y, m.z); }

  double x = 0, y = 0, z = 0;
};

struct PointWire : Vector3Wire {
  static constexpr std::string_view ros_type = "geometry_msgs/Point";
};

struct QuaternionWire {
  static constexpr std::string_view ros_type = "geometry_msgs/Quaternion";
  static auto layout(auto& m) { return fields_of(m.x, m.y, m.z, m.w); }

  double x = 0, y = 0, z = 0, w = 1;
};

struct TransformWire {
  static constexpr std::string_view ros_type = "geometry_msgs/Transform";
  static auto layout(auto& m) { return fields_of(m.translation, m.rotation); }

  Vector3Wire translation;
  QuaternionWire rotation;
};

struct PoseWire {
  static constexpr std::string_view ros_type = "geometry_msgs/Pose";
  static auto layout(auto& m) { return fields_of(m.position, m.orientation); }

  PointWire position;
  QuaternionWire orientation;
};

inline constexpr std::int64_t nanoseconds_of_second = 1'000'000'000;

// from_wire returns what is wrong, or nullptr.

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

[[nodiscard]] inline const char* from_wire(const Vector3Wire& wire, Eigen::Vector3d& vector) {
  vector = {wire.x, wire.y, wire.z};
  return nullptr;
}

inline void to_wire(const Eigen::Vector3d& vector, Vector3Wire& wire) {
  wire.x = vector.x();
  wire.y = vector.y();
  wire.z = vector.z();
}

[[nodiscard]] inline const char* from_wire(const QuaternionWire& wire, Eigen::Vector4d& vector) {
  vector = {wire.x, wire.y, wire.z, wire.w};
  return nullptr;
}

inline void to_wire(const Eigen::Vector4d& vector, QuaternionWire& wire) {
  wire = {vector[0], vector[1], vector[2], vector[3]};
}

[[nodiscard]] inline Eigen::Isometry3d isometry_of(const Vector3Wire& at, const QuaternionWire& q) {
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

inline void isometry_to(const Eigen::Isometry3d& pose, Vector3Wire& at, QuaternionWire& q) {
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
