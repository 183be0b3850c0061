// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stereo_camera.hpp"

#include <memory>

#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/render/depth_renderer.hpp>

#include <sim/arm.hpp>
#include <sim/scene.hpp>
#include <sim/temporary_folder.hpp>

namespace penumbra::study {

/// The simulated arm among eight things before, behind and beside it, seen by a stereo camera. The
/// seed chooses the camera's place and the things; every frame is a new arm pose with the things in
/// new places.
class StereoCell {
 public:
  /// 848 x 480 pixels, fx = 600.
  [[nodiscard]] static Intrinsics intrinsics();

  /// Throws InputError on a machine without OpenGL.
  explicit StereoCell(std::uint64_t seed);

  /// Captures frame `index` into images().
  void capture(std::size_t index);

  [[nodiscard]] const StereoImages& images() const { return images_; }

  /// Renders the robot of the captured frame, without the things.
  [[nodiscard]] VirtualDepthView virtual_depth() { return renderer_->render(poses_); }

 private:
  sim::TemporaryFolder folder_;
  sim::Arm arm_;
  std::unique_ptr<sim::Scene> scene_;
  sim::Stage stage_;
  std::unique_ptr<DepthRenderer> renderer_;
  StereoCamera camera_;
  StereoImages images_;
  std::vector<Eigen::Isometry3d> poses_;  // T_camera_link
};

}  // namespace penumbra::study
