// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// Finds bodies that reach before DepthRenderer::near_plane on rays of the image: what is there is
/// not drawn. By triangles, so that a camera in a bracket's bounds is none; they are looked at only
/// where a body's bounds reach that far, and once for a pose relative to the camera that stays.
class NearPlaneCheck {
 public:
  /// The bodies' meshes must outlive this.
  NearPlaneCheck(const Intrinsics& intrinsics, std::span<const Body> bodies);

  /// Indices of such bodies, rising; valid until the next call. Allocates nothing.
  [[nodiscard]] std::span<const std::size_t> find(std::span<const Eigen::Isometry3d> T_camera_body);

 private:
  struct Part {
    std::span<const TriangleMesh> meshes;
    Eigen::AlignedBox3d bounds;  // in the body's frame
    Eigen::Isometry3d last_pose;
    bool was_asked = false;
    bool last_answer = false;
  };

  [[nodiscard]] bool reaches(Part& part, const Eigen::Isometry3d& T_camera_body) const;

  std::array<Eigen::Vector3d, 4> corners_;  // of the image on the near plane, in turn
  double reach_;                            // metres from the camera to the farthest of them
  std::vector<Part> parts_;
  std::vector<std::size_t> found_;
};

}  // namespace penumbra
