// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/pipeline/attached_bodies-inl.hpp>

namespace penumbra {

AttachedBodies::AttachedBodies(const Intrinsics& intrinsics, Backend backend,
                               const RendererOptions& options)
    : intrinsics_(intrinsics), renderers_(backend, options.isa, max_kept) {}

VirtualDepthView AttachedBodies::add_to(const VirtualDepthView& robot,
                                        std::span<const PlacedBody> bodies,
                                        std::span<const Reach> reaches) {
  copy(robot);
  if (!bodies.empty()) draw(bodies);
  draw_reaches(reaches, intrinsics_, depth_.view(), links_.view(), touched_);
  return {depth_.view(), links_.view(), &touched_};
}

void AttachedBodies::draw(std::span<const PlacedBody> bodies) {
  poses_.clear();
  meshes_.clear();
  for (const PlacedBody& body : bodies) {
    poses_.push_back(body.T_camera_body);
    meshes_.push_back(body.mesh);
  }
  const VirtualDepthView drawn = renderers_.of(meshes_, intrinsics_).render(poses_);
  drawn.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u) {
        const float z = drawn.depth(u, v);
        float& nearest = depth_(u, v);
        if (!(z > 0.0F) || (nearest > 0.0F && nearest <= z)) continue;
        nearest = z;
        links_(u, v) = static_cast<std::uint16_t>(bodies[drawn.links(u, v) - 1U].link + 1);
      }
  });
  for (std::size_t row = 0; row < touched_.rows.size(); ++row)
    touched_.rows[row] |= drawn.touched->rows[row];
}

/// Copies the robot's image, and clears what was drawn in the last frame.
void AttachedBodies::copy(const VirtualDepthView& robot) {
  depth_.fit(robot.depth.width, robot.depth.height);
  links_.fit(robot.depth.width, robot.depth.height);
  touched_.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) {
      std::fill_n(&depth_(u0, v), u1 - u0, 0.0F);
      std::fill_n(&links_(u0, v), u1 - u0, std::uint16_t{0});
    }
  });
  touched_ = *robot.touched;
  touched_.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) {
      std::copy(robot.depth.row(v) + u0, robot.depth.row(v) + u1, &depth_(u0, v));
      std::copy(robot.links.row(v) + u0, robot.links.row(v) + u1, &links_(u0, v));
    }
  });
}

}  // namespace penumbra
