// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/cloud/cloud_labels.hpp>
#include <penumbra/poses/robot_pose.hpp>

namespace penumbra {

struct ReceivedCloud;  // defined by the sources that read them

/// The points of a scan, or of a cloud that is measured at once, in the sensor's frame.
struct Scan {
  PointsView points = {};
  /// When each point was measured: nanoseconds after the frame's stamp. Empty: all at the stamp, as
  /// points without rays are.
  std::span<const std::int32_t> times = {};
  /// Where the rays start, in the points' frame. Null: points without rays, as of merged clouds.
  std::optional<Eigen::Vector3d> origin = Eigen::Vector3d::Zero();
  std::shared_ptr<const void> owner = {};  ///< keeps points and times; may be null
  /// What the points were read from, for outputs that write it without the robot; null: not known.
  std::shared_ptr<const ReceivedCloud> received = {};
};

/// Returns a scan with points and times of its own.
[[nodiscard]] inline Scan copy_of(const Scan& scan) {
  const auto own = std::make_shared<std::pair<std::vector<float>, std::vector<std::int32_t>>>();
  for (std::size_t i = 0; i < scan.points.count; ++i) {
    const Eigen::Vector3f point = scan.points[i];
    own->first.insert(own->first.end(), point.begin(), point.end());
  }
  own->second.assign(scan.times.begin(), scan.times.end());
  return {.points = {reinterpret_cast<const std::byte*>(own->first.data()), scan.points.count},
          .times = own->second,
          .origin = scan.origin,
          .owner = own};
}

/// Sets `pose` to the robot's pose at a stamp, or its fault, as PoseLookup::at.
using PoseAt = std::function<void(std::int64_t stamp, RobotPose& pose)>;

/// A sensor that measures points.
struct CloudConfig {
  /// During a scan with times, the robot's poses are looked up so often that no link moves by more
  /// than 1 cm in between, or so many times.
  static constexpr std::size_t max_parts = 64;
  /// Metres. If half of the points are farther away, they are no measurement: no sensor of a
  /// robot's surroundings sees so far, and millimetres are mistaken for metres.
  static constexpr double max_range = 300.0;

  CloudRule rule = {};
  int threads = 1;
  std::string sensor_parent = {};  ///< link that carries the sensor; empty: the root
  /// Pose of the points' frame in that link's frame, metres. RobotPose::T_parent_camera, where
  /// given, replaces it.
  Eigen::Isometry3d T_parent_sensor = Eigen::Isometry3d::Identity();
  double target_history = 0.0;  ///< as in PipelineConfig, of scans
};

}  // namespace penumbra
