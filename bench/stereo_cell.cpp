// SPDX-License-Identifier: Apache-2.0
#include "stereo_cell.hpp"

namespace penumbra::study {
namespace {

constexpr double frame_rate = 30.0;  // turns a frame's number into the scene's time

RobotOptions visual_geometry() {
  RobotOptions options;
  options.geometry = Geometry::visual;
  options.geometry_fallback = true;
  return options;
}

sim::SceneOptions scene_options(std::uint64_t seed) {
  return {.seed = seed, .belt_jitter = 0.0, .frame_rate = frame_rate, .duration = 0.0};
}

std::vector<Body> bodies_of(const Robot& robot) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], robot.meshes(i)});
  return bodies;
}

}  // namespace

Intrinsics StereoCell::intrinsics() { return {848, 480, 600.0, 600.0, 423.5, 239.5}; }

StereoCell::StereoCell(std::uint64_t seed)
    : arm_(PENUMBRA_STUDY_ARM, visual_geometry(), folder_.path()),
      scene_(sim::make_random_targets(arm_, scene_options(seed), intrinsics())),
      stage_(arm_, scene_->description(), folder_.path(), intrinsics()),
      renderer_(make_depth_renderer(Backend::cpu, intrinsics(), bodies_of(arm_.robot()), {})),
      camera_(intrinsics(), seed),
      poses_(arm_.robot().links().size()) {}

void StereoCell::capture(std::size_t index) {
  const double time = static_cast<double>(index) / frame_rate;
  const std::vector<double> joints = scene_->joints(time);
  stage_.place(joints, scene_->pose(time).parts);
  const Eigen::Isometry3d& T_base_camera = scene_->description().T_base_camera;
  camera_.capture(stage_, T_base_camera, images_);
  arm_.robot().forward_kinematics(joints, poses_);
  for (Eigen::Isometry3d& pose : poses_) pose = T_base_camera.inverse() * pose;
}

}  // namespace penumbra::study
