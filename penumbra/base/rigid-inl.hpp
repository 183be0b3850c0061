// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include <Eigen/Geometry>

namespace penumbra {

/// Whether a transform is finite and its linear part a rotation (to 1e-4, as for rotations in
/// files).
[[nodiscard]] inline bool is_rigid(const Eigen::Isometry3d& T) {
  constexpr double rotation_error = 1e-4;  // of any element of R^T R
  const Eigen::Matrix3d R = T.linear();
  const Eigen::Matrix3d error = R.transpose() * R - Eigen::Matrix3d::Identity();
  return T.matrix().allFinite() && error.cwiseAbs().maxCoeff() <= rotation_error &&
         R.determinant() > 0.0;
}

/// Returns how far two poses differ, metres; a turn counts as the way of a point 10 cm away.
[[nodiscard]] inline double pose_difference(const Eigen::Isometry3d& a,
                                            const Eigen::Isometry3d& b) {
  constexpr double lever = 0.1;
  return (a.translation() - b.translation()).norm() +
         lever * Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// Returns the largest difference of as many poses.
[[nodiscard]] inline double pose_difference(std::span<const Eigen::Isometry3d> a,
                                            std::span<const Eigen::Isometry3d> b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, pose_difference(a[i], b[i]));
  return most;
}

}  // namespace penumbra
