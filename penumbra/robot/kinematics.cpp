// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <stdexcept>
#include <string>

#include <penumbra/robot/robot_model-inl.hpp>

namespace penumbra {
namespace {

// Positions beyond this are no position of a joint; it also keeps every pose finite.
constexpr double kLargestPosition = 1e9;
constexpr double kShortestQuaternion = 1e-6;

Eigen::Isometry3d turned(double angle, const Eigen::Vector3d& axis) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  return pose;
}

Eigen::Isometry3d shifted(const Eigen::Vector3d& by) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = by;
  return pose;
}

Eigen::Isometry3d planar(const double* x_y_yaw, const Eigen::Vector3d& normal) {
  const Eigen::Matrix3d plane = plane_axes(normal);
  Eigen::Isometry3d pose = turned(x_y_yaw[2], normal);
  pose.translation() = plane.col(0) * x_y_yaw[0] + plane.col(1) * x_y_yaw[1];
  return pose;
}

Eigen::Isometry3d floating(const double* xyz_xyzw) {
  Eigen::Isometry3d pose = shifted({xyz_xyzw[0], xyz_xyzw[1], xyz_xyzw[2]});
  const Eigen::Vector4d q(xyz_xyzw[3], xyz_xyzw[4], xyz_xyzw[5], xyz_xyzw[6]);
  pose.linear() = Eigen::Quaterniond(q.stableNormalized()).toRotationMatrix();
  return pose;
}

// T_joint_child at the positions.
Eigen::Isometry3d motion(const Joint& joint, std::span<const double> positions) {
  if (joint.type == JointType::fixed) return Eigen::Isometry3d::Identity();
  const double* value = &positions[*joint.variable];
  if (joint.type == JointType::planar) return planar(value, joint.axis);
  if (joint.type == JointType::floating) return floating(value);
  const double position = joint.multiplier * *value + joint.offset;
  if (joint.type == JointType::prismatic) return shifted(joint.axis * position);
  return turned(position, joint.axis);
}

void require_positions(const Robot& robot, std::span<const double> positions, std::size_t poses) {
  if (positions.size() != robot.variables().size() || poses != robot.links().size())
    throw std::invalid_argument(
        "forward_kinematics: one position per variable and one pose per link");
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!(std::abs(positions[i]) <= kLargestPosition))
      throw std::invalid_argument("forward_kinematics: position of " + robot.variables()[i] +
                                  " is not within +-1e9");
  for (const Joint& joint : robot.joints()) {
    if (joint.type != JointType::floating) continue;
    const double* q = &positions[*joint.variable + 3];
    if (!(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])) >= kShortestQuaternion))
      throw std::invalid_argument("forward_kinematics: quaternion of " + joint.name + " is zero");
  }
}

}  // namespace

Eigen::Matrix3d plane_axes(const Eigen::Vector3d& normal) {
  // Without loss of digits for any normal: Duff et al., Building an Orthonormal Basis, Revisited,
  // JCGT 6(1), 2017.
  const double sign = normal.z() >= 0.0 ? 1.0 : -1.0;
  const double f = -1.0 / (sign + normal.z());
  const double x = normal.x();
  const double y = normal.y();
  Eigen::Matrix3d axes;
  axes.col(0) << 1.0 + sign * x * x * f, sign * x * y * f, -sign * x;
  axes.col(1) << x * y * f, sign + y * y * f, -y;
  axes.col(2) = normal;
  return axes;
}

void Robot::forward_kinematics(std::span<const double> positions,
                               std::span<Eigen::Isometry3d> T_root_link) const {
  require_positions(*this, positions, T_root_link.size());
  T_root_link[0].setIdentity();
  for (const Joint& joint : joints())
    T_root_link[joint.child] =
        T_root_link[joint.parent] * (joint.origin * motion(joint, positions));
}

}  // namespace penumbra
