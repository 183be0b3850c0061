// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::bench {

/// The comparator for ray casting: Embree in its robust mode on the calling thread. One tree per
/// body, built once at high quality, instances moved every frame; coherent rays in packets of 4x4
/// pixels, several packets a call: the fastest of the packet sizes, shapes and calls tried. Rays
/// are cast in the rectangle around the robot.
class EmbreeTracer {
 public:
  EmbreeTracer(const Intrinsics& intrinsics, std::span<const Body> bodies);
  ~EmbreeTracer();
  EmbreeTracer(const EmbreeTracer&) = delete;
  EmbreeTracer& operator=(const EmbreeTracer&) = delete;

  /// Metres, 0 where nothing is; valid until the next call.
  ImageView<const float> render(std::span<const Eigen::Isometry3d> T_camera_body);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::bench
