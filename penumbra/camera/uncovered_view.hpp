// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>

namespace penumbra {

/// What of a raw image its pinhole image does not cover: rays beyond a cone about the optical axis,
/// on the sides to which the raw image reaches that far. What is seen there cannot be drawn.
class UncoveredView {
 public:
  /// `rectification`: of that camera.
  UncoveredView(const Camera& raw, const Rectification& rectification);

  /// Whether the point, in the optical frame, may be seen there.
  [[nodiscard]] bool holds(const Eigen::Vector3d& point) const;

  /// Whether any of what the box holds may be seen there.
  [[nodiscard]] bool holds_part_of(const Eigen::AlignedBox3d& box,
                                   const Eigen::Isometry3d& T_camera_box) const;

 private:
  static constexpr int sectors = 64;  // about the optical axis

  [[nodiscard]] bool is_covered(const Eigen::Vector3d& point) const;
  [[nodiscard]] bool holds_part_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] static int sector_of(const Eigen::Vector3d& point);

  double reach_;                  // of the cone, at z = 1
  std::bitset<sectors> sectors_;  // with uncovered pixels, or beside such
};

}  // namespace penumbra
