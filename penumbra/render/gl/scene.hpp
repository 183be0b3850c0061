// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/triangle_groups.hpp>

namespace penumbra::gl {

/// The bodies' meshes in the device's memory. All calls need the context that it was made in; its
/// OpenGL objects die with that.
class Scene {
 public:
  /// Throws InputError where the meshes are larger than the device takes. `frames` of them may be
  /// in flight.
  Scene(const Intrinsics& intrinsics, std::span<const Body> bodies, std::size_t frames);

  /// Takes the poses of frame `slot` and chooses what to draw of it. Returns where it may be seen.
  PixelRectangle place(std::span<const Eigen::Isometry3d> T_camera_body, std::size_t slot);

  /// Draws what the last place() chose.
  void draw() const;

 private:
  struct Part {
    std::uint32_t body;
    bool solid, has_holes;
    Eigen::AlignedBox3d bounds;  // in the body's frame
    std::uint32_t index_count, first_index, first_vertex;
  };
  /// As glMultiDrawElementsIndirect reads it.
  struct Command {
    std::uint32_t index_count, instance_count, first_index, first_vertex, body;
  };
  /// What the shaders know of a body.
  struct Placement {
    /// Rows of the matrix from its frame to clip coordinates, but for the constant third.
    std::array<float, 12> to_clip;
    std::array<float, 2> depths;  ///< its box's nearest and farthest, in metres
  };

  void upload(std::span<const Body> bodies);
  void make_stream(std::size_t bodies, std::size_t frames);
  [[nodiscard]] Placement placement(std::size_t body, const Eigen::Isometry3d& T_camera_body) const;

  Intrinsics intrinsics_;
  SideRule side_rule_;
  std::vector<Part> parts_;
  std::vector<Eigen::AlignedBox3d> body_bounds_;  // in the bodies' frames
  unsigned vertex_array_ = 0;
  unsigned stream_ = 0;               // for each frame its placements, then its commands
  std::byte* stream_data_ = nullptr;  // mapped
  std::size_t commands_at_ = 0;       // bytes from a frame's start
  std::size_t frame_size_ = 0;        // bytes
  std::size_t slot_ = 0;
  std::size_t front_count_ = 0;  // commands with back faces culled; they come first
  std::size_t both_count_ = 0;   // and those of both sides, at the end of the commands' room
};

}  // namespace penumbra::gl
