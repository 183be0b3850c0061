// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/pipeline/attached_bodies-inl.hpp>

namespace penumbra {

AttachedBodies::AttachedBodies(const Intrinsics& intrinsics, const PipelineConfig& config)
    : intrinsics_(intrinsics),
      backend_(config.backend == Backend::reference ? Backend::reference : Backend::cpu),
      options_{.threads = 1, .isa = config.renderer.isa} {}

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
  for (const PlacedBody& body : bodies) poses_.push_back(body.T_camera_body);
  const VirtualDepthView drawn = renderer_of(bodies).render(poses_);
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

DepthRenderer& AttachedBodies::renderer_of(std::span<const PlacedBody> bodies) {
  const auto is_it = [&](const Kept& kept) {
    return std::equal(kept.meshes.begin(), kept.meshes.end(), bodies.begin(), bodies.end(),
                      [](const auto& mesh, const PlacedBody& body) { return mesh == body.mesh; });
  };
  const auto found = std::find_if(kept_.begin(), kept_.end(), is_it);
  if (found != kept_.end()) {
    std::rotate(found, found + 1, kept_.end());
    return *kept_.back().renderer;
  }
  if (kept_.size() == max_kept) kept_.erase(kept_.begin());
  Kept kept;
  std::vector<Body> all;
  for (const PlacedBody& body : bodies) {
    kept.meshes.push_back(body.mesh);
    all.push_back({body.name, {body.mesh.get(), 1}});
  }
  kept.renderer = make_depth_renderer(backend_, intrinsics_, all, options_);
  return *kept_.emplace_back(std::move(kept)).renderer;
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
