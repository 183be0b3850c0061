// SPDX-License-Identifier: Apache-2.0
#include "robot_views.hpp"

#include "data.hpp"
#include "embree_oracle.hpp"
#include "shapes.hpp"

#include <cmath>
#include <optional>

namespace penumbra::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vector3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return Vector3d(x, y, normal(random)).normalized();
}

std::vector<Isometry3d> random_link_poses(std::mt19937_64& random, const Robot& robot) {
  std::vector<double> positions = robot.rest_positions();
  for (double& q : positions) q = uniform(random, -2.0, 2.0);
  std::vector<Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  return poses;
}

/// A point of the robot's surface and a direction away from it, seen from far away.
struct SurfacePoint {
  Vector3d position, outwards;
};

std::optional<SurfacePoint> random_surface_point(std::mt19937_64& random,
                                                 const std::vector<Body>& bodies,
                                                 const std::vector<Isometry3d>& T_root_link) {
  // A camera 3 m away that looks at a random link's origin.
  const Vector3d aim =
      T_root_link[random() % T_root_link.size()].translation() + 0.05 * random_direction(random);
  const Vector3d towards = random_direction(random);
  const Quaterniond rotation = turn(towards, Vector3d::UnitZ());
  const Isometry3d T_eye_root =
      Eigen::Translation3d(0, 0, 3) * rotation * Eigen::Translation3d(-aim);
  std::vector<Isometry3d> poses = T_root_link;
  for (Isometry3d& pose : poses) pose = T_eye_root * pose;
  const auto hit = EmbreeOracle(bodies, poses).first_hit(Vector3d::UnitZ(), 0.01);
  if (!hit) return std::nullopt;
  return SurfacePoint{T_eye_root.inverse() * Vector3d(0, 0, hit->z), -towards};
}

/// The camera at `position` in which the ray of a random pixel passes through `target`.
Isometry3d aimed_camera(std::mt19937_64& random, const Intrinsics& intrinsics,
                        const Vector3d& position, const Vector3d& target) {
  const double u = uniform(random, 0.2, 0.8) * intrinsics.width();
  const double v = uniform(random, 0.2, 0.8) * intrinsics.height();
  const Quaterniond aim = turn(target - position, intrinsics.ray(u, v));
  const Eigen::AngleAxisd roll(uniform(random, -M_PI, M_PI), intrinsics.ray(u, v).normalized());
  return roll * aim * Eigen::Translation3d(-position);
}

std::optional<Isometry3d> random_camera(std::mt19937_64& random, const std::vector<Body>& bodies,
                                        const Intrinsics& intrinsics,
                                        const std::vector<Isometry3d>& T_root_link, ViewKind kind) {
  const auto seen = random_surface_point(random, bodies, T_root_link);
  if (!seen) return std::nullopt;
  switch (kind) {
    case ViewKind::outside:
      return aimed_camera(random, intrinsics,
                          seen->position + seen->outwards * uniform(random, 0.6, 2.5),
                          seen->position);
    case ViewKind::eye_in_hand:
      return aimed_camera(random, intrinsics,
                          T_root_link.back() * (0.09 * random_direction(random)), seen->position);
    case ViewKind::at_the_skin:
      return aimed_camera(random, intrinsics,
                          seen->position + seen->outwards * uniform(random, 0.001, 0.012),
                          seen->position + 0.05 * random_direction(random));
  }
  return std::nullopt;
}

}  // namespace

Robot load_robot(const std::string& name, Geometry geometry) {
  const auto folder = data_folder() / "robots" / name;
  RobotOptions options;
  options.geometry = geometry;
  return Robot::load(folder / (name + ".urdf"), options);
}

std::vector<Body> link_bodies(const Robot& robot) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], robot.meshes(i)});
  return bodies;
}

Intrinsics random_intrinsics(std::mt19937_64& random, int width, int height) {
  const double fx = uniform(random, 0.5, 1.6) * width;
  const double fy = fx * uniform(random, 0.9, 1.1);
  const double cx = uniform(random, -0.5, 1.5) * width;
  return {width, height, fx, fy, cx, uniform(random, -0.5, 1.5) * height};
}

std::vector<Isometry3d> random_view(std::mt19937_64& random, const Robot& robot,
                                    const std::vector<Body>& bodies, const Intrinsics& intrinsics,
                                    ViewKind kind) {
  for (;;) {
    std::vector<Isometry3d> poses = random_link_poses(random, robot);
    const auto T_camera_root = random_camera(random, bodies, intrinsics, poses, kind);
    if (!T_camera_root) continue;
    for (Isometry3d& pose : poses) pose = *T_camera_root * pose;
    if (!EmbreeOracle(bodies, poses).camera_is_inside()) return poses;
  }
}

}  // namespace penumbra::test
