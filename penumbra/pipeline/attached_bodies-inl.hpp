// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/mesh_renderers.hpp>

namespace penumbra {

/// Draws attached bodies, and what links of unknown pose could reach, into the robot's virtual
/// depth image. Each set of meshes has a renderer.
class AttachedBodies {
 public:
  static constexpr std::size_t max_kept = 8;  ///< renderers

  AttachedBodies(const Intrinsics& intrinsics, Backend backend, const RendererOptions& options);

  /// Returns the robot together with the bodies and balls; the nearest surface wins. Valid until
  /// the next call.
  VirtualDepthView add_to(const VirtualDepthView& robot, std::span<const PlacedBody> bodies,
                          std::span<const Reach> reaches);

 private:
  void copy(const VirtualDepthView& robot);
  void draw(std::span<const PlacedBody> bodies);

  Intrinsics intrinsics_;
  MeshRenderers renderers_;
  MeshRenderers::Meshes meshes_;
  std::vector<Eigen::Isometry3d> poses_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
  TileMask touched_;
};

}  // namespace penumbra
