// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::bench {

/// The comparator for rasterising in software: Mesa's llvmpipe through EGL without a surface, on
/// the calling thread. 32-bit depth, back faces culled, welded meshes uploaded once, one matrix per
/// link and frame; the depth buffer is read back and turned into metres.
class LlvmpipeRenderer {
 public:
  /// Sets the driver's environment. Throws std::runtime_error without llvmpipe.
  LlvmpipeRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies);
  ~LlvmpipeRenderer();
  LlvmpipeRenderer(const LlvmpipeRenderer&) = delete;
  LlvmpipeRenderer& operator=(const LlvmpipeRenderer&) = delete;

  /// Metres, 0 where nothing is; valid until the next call.
  ImageView<const float> render(std::span<const Eigen::Isometry3d> T_camera_body);

  /// What OpenGL says of itself.
  [[nodiscard]] std::string description() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::bench
