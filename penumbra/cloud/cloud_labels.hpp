// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/labels/labels.hpp>
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

}  // namespace penumbra
