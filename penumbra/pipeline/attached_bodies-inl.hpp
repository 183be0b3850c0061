// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/labelled_frame-inl.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// Draws attached bodies, and what links of unknown pose could reach, into the robot's virtual
/// depth image, on one thread of the CPU. Each set of meshes has a renderer; the last ones are
/// cached, so that a body attached again costs nothing.
class AttachedBodies {
 public:
  static constexpr std::size_t max_kept = 8;  ///< renderers, of 14 MB each at 1280x720

  AttachedBodies(const Intrinsics& intrinsics, const PipelineConfig& config);

  /// Returns the robot together with the bodies and balls; the nearest surface wins. Valid until
  /// the next call.
  VirtualDepthView add_to(const VirtualDepthView& robot, std::span<const PlacedBody> bodies,
                          std::span<const Reach> reaches);

 private:
  struct Kept {
    std::vector<std::shared_ptr<const PreparedMesh>> meshes;
    std::unique_ptr<DepthRenderer> renderer;
  };
  DepthRenderer& renderer_of(std::span<const PlacedBody> bodies);
  void copy(const VirtualDepthView& robot);
  void draw(std::span<const PlacedBody> bodies);

  Intrinsics intrinsics_;
  Backend backend_;
  RendererOptions options_;
  std::vector<Kept> kept_;  // the last used one at the end
  std::vector<Eigen::Isometry3d> poses_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
  TileMask touched_;
};

}  // namespace penumbra
