// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// Finds bodies with a part between the camera and DepthRenderer::near_plane in the image; this
/// part is not drawn. Tests triangles, so a camera within a bracket's bounding box is no problem;
/// only of bodies whose bounds come that near, and once per pose relative to the camera.
class NearPlaneCheck {
 public:
  /// The bodies' meshes must outlive this.
  NearPlaneCheck(const Intrinsics& intrinsics, std::span<const Body> bodies);

  /// Returns the indices of such bodies, rising; valid until the next call. Allocates nothing.
  [[nodiscard]] std::span<const std::size_t> find(std::span<const Eigen::Isometry3d> T_camera_body);

 private:
  struct Part {
    std::span<const PreparedMesh> meshes;
    Eigen::AlignedBox3d bounds;  // in the body's frame
    std::optional<Eigen::Isometry3d> last_pose;
    bool last_answer = false;
  };

  [[nodiscard]] bool reaches(Part& part, const Eigen::Isometry3d& T_camera_body) const;
  [[nodiscard]] bool reaches(const PreparedMesh& mesh,
                             const Eigen::Isometry3d& T_camera_body) const;

  /// Of the pyramid between the camera and the near plane: plane . (x, y, z, 1) >= 0 inside.
  std::array<Eigen::Vector4d, 5> planes_;
  double reach_ = 0.0;  // metres from the camera to the pyramid's farthest corner
  std::vector<Part> parts_;
  std::vector<std::size_t> found_;
};

}  // namespace penumbra
