// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/image_space.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/mesh_renderers.hpp>

namespace penumbra {

/// Renders objects alone. Each mesh has its own renderer; boxes, whose size may change with every
/// frame, are ray cast.
class ObjectRenderers {
 public:
  /// Renderers that are kept; those of more meshes in one frame are made again each time.
  static constexpr std::size_t max_kept = 32;

  /// `rectification`: for raw images of `camera` with lens distortion, else null; then `intrinsics`
  /// are of the images. The rectification must outlive this.
  ObjectRenderers(const Intrinsics& intrinsics, Backend backend, const RendererOptions& options,
                  const Rectification* rectification, const Camera& camera);

  /// Returns the depth of a box or mesh; valid until the next call. Throws InputError for a
  /// mesh without triangles.
  VirtualDepthView box(const Eigen::Vector3d& size, const Eigen::Isometry3d& T_camera_box);
  VirtualDepthView mesh(const std::shared_ptr<const PreparedMesh>& mesh,
                        const Eigen::Isometry3d& T_camera_mesh);

 private:
  void prepare();
  VirtualDepthView in_image(const VirtualDepthView& rendered);
  void clear_box();

  Intrinsics intrinsics_;
  MeshRenderers renderers_;
  const Rectification* rectification_;
  Camera camera_;
  std::optional<Rectification> fine_;    // made with the first object
  std::optional<RawImages> raw_images_;  // made with the first object
  Image<float> box_depth_;               // made with the first box
  Image<std::uint16_t> box_links_;       // zeros
  TileMask box_touched_;
};

}  // namespace penumbra
