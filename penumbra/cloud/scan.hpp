// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/labels/labels.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// Points in memory: x, y, z as float32, metres. Coordinates that are not finite, and points less
/// than CloudLabeller::least_range from the sensor, are "no measurement".
struct PointsView {
  const std::byte* data = nullptr;  ///< the first x
  std::size_t count = 0;
  std::ptrdiff_t stride = 3 * sizeof(float);  ///< bytes from a point to the next

  [[nodiscard]] Eigen::Vector3f operator[](std::size_t i) const;
};

/// The labels of a scan, in the order of its points. unknown: no measurement, or `enclosing`.
struct CloudLabels {
  std::vector<std::uint8_t> labels;  ///< values of Label
  std::vector<std::uint16_t>
      links;  ///< body index + 1 of the robot that decided; 0: clear, unknown
  /// Body that the origin lies in, or less than least_range from: all labels are unknown; with
  /// parts, those of the parts where it is so.
  std::optional<std::size_t> enclosing;
};

/// Says of each point of a cloud whether it is the robot's. Decides most points by virtual depth on
/// the faces of a cube around the sensor, and those next to an edge by casting their rays. What is
/// thinner than 0.17 degrees may be missed: its points are then clear or, before other robot,
/// front. Serves one thread at a time.
class CloudLabeller {
 public:
  /// Metres. Robot that is nearer may not be drawn: the near plane's farthest point is at 0.018.
  static constexpr double least_range = 0.02;

  /// The spans need only live during the call. Results do not depend on the number of threads.
  /// Throws InputError as make_depth_renderer() and for an invalid rule.
  explicit CloudLabeller(std::span<const Body> bodies, const CloudRule& rule = {}, int threads = 1);
  ~CloudLabeller();
  CloudLabeller(CloudLabeller&&) noexcept;
  CloudLabeller& operator=(CloudLabeller&&) noexcept;

  /// Labels by another rule from now on. Throws InputError for an invalid one.
  void set_rule(const CloudRule& rule);

  /// Labels points that a sensor at `origin` measured, by the bodies' poses T_points_body, all in
  /// the frame of the points. The result is valid until the next call. Allocates nothing
  /// once its lists are long enough. Throws std::invalid_argument for a wrong number of poses, one
  /// that is not rigid, and more than 2^32 - 1 points.
  ///
  /// `parts`: for robots that move during the scan, the part of the scan that each point is of;
  /// T_points_body then has the poses of all bodies in part 0, in part 1 and so on. Empty: one
  /// part.
  const CloudLabels& label(const PointsView& points, const Eigen::Vector3d& origin,
                           std::span<const Eigen::Isometry3d> T_points_body,
                           std::span<const std::uint16_t> parts = {});

  /// The same for points without rays, as of merged clouds: those at most e(0) from the robot's
  /// surface, and those inside a closed surface, are occluded, the others clear.
  const CloudLabels& label(const PointsView& points,
                           std::span<const Eigen::Isometry3d> T_points_body);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

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
