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
#include <penumbra/mesh/triangle_mesh.hpp>
#include <penumbra/pipeline/image_space-inl.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// Renders objects alone, on one thread of the CPU. Each mesh has its own renderer, which is
/// cached; boxes, whose size may change with every frame, are ray cast.
class ObjectRenderers {
 public:
  /// Cached renderers; more meshes in one frame are prepared again each time.
  static constexpr std::size_t max_kept = 32;

  /// `rectification`: for raw images of `camera` with lens distortion, else null; then `intrinsics`
  /// are of the images. The rectification must outlive this.
  ObjectRenderers(const Intrinsics& intrinsics, const PipelineConfig& config,
                  const Rectification* rectification, const Camera& camera);
  ~ObjectRenderers();

  /// Returns the depth of a box or mesh; valid until the next call. Throws InputError for an
  /// invalid mesh.
  VirtualDepthView box(const Eigen::Vector3d& size, const Eigen::Isometry3d& T_camera_box);
  VirtualDepthView mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                        const Eigen::Isometry3d& T_camera_mesh);

 private:
  struct Kept;
  VirtualDepthView render(Kept& kept, const Eigen::Isometry3d& T_camera_object);
  void prepare();
  VirtualDepthView in_image(const VirtualDepthView& rendered);
  void clear_box();
  Kept& place();

  Intrinsics intrinsics_;
  Backend backend_;
  RendererOptions options_;
  const Rectification* rectification_;
  Camera camera_;
  std::optional<Rectification> fine_;    // made with the first object
  std::optional<RawImages> raw_images_;  // made with the first object
  Image<float> box_depth_;               // made with the first box
  Image<std::uint16_t> box_links_;       // zeros
  TileMask box_touched_;
  std::vector<std::unique_ptr<Kept>> kept_;
  std::size_t uses_ = 0;
};

}  // namespace penumbra
