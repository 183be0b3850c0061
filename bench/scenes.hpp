// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::bench {

using LinkPoses = std::vector<Eigen::Isometry3d>;  ///< T_camera_link of every link

/// A robot that moves before a camera.
struct BenchScene {
  std::string name;
  Intrinsics intrinsics;
  std::shared_ptr<const Robot> robot;
  std::vector<LinkPoses> path;                   ///< a smooth motion, one entry per frame
  std::vector<std::vector<double>> joints = {};  ///< positions of the same frames
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  std::function<Robot()> load_robot = {};  ///< another one like it

  [[nodiscard]] std::vector<Body> bodies() const { return bodies_of(*robot); }
};

/// Folder of robots and recordings: PENUMBRA_DATA or the one given to CMake.
[[nodiscard]] std::filesystem::path data_folder();

/// A UR5e that swings each joint at its own speed, 1.2 m before a camera whose image is
/// width x height with focal length f.
[[nodiscard]] BenchScene ur5e_scene(Geometry geometry, int width, int height, double f,
                                    std::size_t frames, std::uint64_t seed);

/// `count` UR5e, at most 8, joined (Robot::join), in two rows before a 1280x720 camera that sees
/// all eight places.
[[nodiscard]] BenchScene ur5e_cell(std::size_t count, std::size_t frames, std::uint64_t seed);

/// The recorded xArm 7: its camera, and a path through its ten poses.
[[nodiscard]] BenchScene xarm7_scene(std::size_t frames);

/// Depth images as a sensor would give them, one per frame: the robot, a wall behind, noise and
/// holes.
[[nodiscard]] std::vector<Image<std::uint16_t>> sensor_images(DepthRenderer& renderer,
                                                              const BenchScene& scene);

/// `count` robots of no kind: spheres of `triangles` in all, which circle before a 1280x720 camera.
class SphereScene {
 public:
  SphereScene(std::size_t count, std::size_t triangles);

  [[nodiscard]] std::vector<Body> bodies() const;
  [[nodiscard]] std::size_t triangle_count() const;
  [[nodiscard]] std::vector<LinkPoses> path(std::size_t frames) const;

 private:
  std::size_t count_;
  std::vector<PreparedMesh> mesh_;  // one, which all bodies share
  double radius_;
};

}  // namespace penumbra::bench
