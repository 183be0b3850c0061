// SPDX-License-Identifier: Apache-2.0
#include <sim/scene.hpp>

namespace penumbra::sim {

Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = eye;
  return pose;
}

Eigen::Isometry3d tool_pose(const Eigen::Vector3d& position, const Eigen::Vector3d& ahead,
                            const Eigen::Vector3d& sideways) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z = ahead.normalized();
  const Eigen::Vector3d y = (sideways - sideways.dot(z) * z).normalized();
  pose.linear() << y.cross(z), y, z;
  pose.translation() = position;
  return pose;
}

}  // namespace penumbra::sim
