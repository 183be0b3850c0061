// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <research/object_fit.hpp>

namespace penumbra::research {
namespace {

constexpr double reach = 0.06;           // metres around the expected outline that are searched
constexpr double top_band = 0.015;       // metres around the height of the object's top
constexpr double outline_error = 0.012;  // metres by which the outline's size may be wrong
constexpr double most_turn = 0.35;       // radians from the expected orientation
constexpr int turns = 36;                // steps to each side
constexpr std::size_t least_points = 200;
constexpr double position_sigma = 0.004, rotation_sigma = 0.03;  // metres, radians

/// Adds the points of one camera, in the base frame, that may be on the object's top.
void add_points(const Camera& camera, const Eigen::Isometry3d& T_base_camera,
                ImageView<const std::uint16_t> depth, const Eigen::Vector3d& centre, double top,
                double radius, std::vector<Eigen::Vector2d>& points) {
  if (depth.empty()) return;
  const Eigen::Vector3d p = T_base_camera.inverse() * centre;
  if (p.z() <= 0) return;
  const Eigen::Vector2d middle = camera.intrinsics.project(p);
  const double r = radius / p.z() * camera.intrinsics.fx() * 1.2;  // nearer points look larger
  const int u0 = static_cast<int>(std::max(middle.x() - r, 0.0));
  const int v0 = static_cast<int>(std::max(middle.y() - r, 0.0));
  const int u1 = static_cast<int>(std::min(middle.x() + r, depth.width - 1.0));
  const int v1 = static_cast<int>(std::min(middle.y() + r, depth.height - 1.0));
  for (int v = v0; v <= v1; ++v)
    for (int u = u0; u <= u1; ++u) {
      if (depth(u, v) == 0) continue;
      const Eigen::Vector3d q =
          surface_at(camera.intrinsics, T_base_camera, u, v, depth(u, v) * metres_per_unit);
      if (std::abs(q.z() - top) < top_band && (q - centre).head<2>().norm() < radius)
        points.push_back(q.head<2>());
    }
}

struct Outline {
  double area = std::numeric_limits<double>::infinity();
  double angle = 0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero(), size = Eigen::Vector2d::Zero();
};

/// Returns the outline along directions turned by `angle`, without the outermost hundredth at each
/// side.
Outline outline_at(const std::vector<Eigen::Vector2d>& points, double angle) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  std::vector<double> along(points.size());
  Outline outline;
  outline.angle = angle;
  Eigen::Vector2d middle;
  for (int axis = 0; axis < 2; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = turn.col(axis).dot(points[i]);
    const auto cut = static_cast<std::ptrdiff_t>(points.size() / 100);
    std::nth_element(along.begin(), along.begin() + cut, along.end());
    const double from = along[static_cast<std::size_t>(cut)];
    std::nth_element(along.begin(), along.end() - 1 - cut, along.end());
    const double to = along[along.size() - 1 - static_cast<std::size_t>(cut)];
    middle(axis) = 0.5 * (from + to);
    outline.size(axis) = to - from;
  }
  outline.centre = turn * middle;
  outline.area = outline.size.prod();
  return outline;
}

}  // namespace

double box_depth(const Eigen::Isometry3d& T_object_camera, const Eigen::Vector3d& size,
                 const Eigen::Vector3d& ray) {
  const Eigen::Vector3d from = T_object_camera.translation(), to = T_object_camera.linear() * ray;
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * size(axis);
    if (to(axis) == 0) {
      if (std::abs(from(axis)) > half) return 0;
      continue;
    }
    const double a = (-half - from(axis)) / to(axis), b = (half - from(axis)) / to(axis);
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave ? enter : 0;
}

std::optional<PoseEstimate> fit_object(const Cell& cell, const Observation& observed,
                                       const Eigen::Isometry3d& expected) {
  const double top = cell.belt_height + cell.object_size.z();
  const double radius = 0.5 * cell.object_size.head<2>().norm() + reach;
  std::vector<Eigen::Vector2d> points;
  add_points(cell.camera, cell.T_base_camera, observed.depth, expected.translation(), top, radius,
             points);
  add_points(cell.camera, cell.T_base_second_camera, observed.second_depth, expected.translation(),
             top, radius, points);
  if (points.size() < least_points) return std::nullopt;
  const Eigen::Vector3d x = expected.linear().col(0);
  const double yaw = std::atan2(x.y(), x.x());
  Outline best;
  for (int i = -turns; i <= turns; ++i) {
    const Outline outline = outline_at(points, yaw + most_turn * i / turns);
    if (outline.area < best.area) best = outline;
  }
  if ((best.size - cell.object_size.head<2>()).cwiseAbs().maxCoeff() > outline_error)
    return std::nullopt;
  PoseEstimate estimate;
  estimate.stamp = observed.stamp;
  estimate.pose.linear() =
      Eigen::AngleAxisd(best.angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  estimate.pose.translation() << best.centre, cell.belt_height + 0.5 * cell.object_size.z();
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(position_sigma), Eigen::Vector3d::Constant(rotation_sigma);
  estimate.covariance = Matrix6d(sigmas.cwiseAbs2().asDiagonal());
  return estimate;
}

}  // namespace penumbra::research
