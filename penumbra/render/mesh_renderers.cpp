// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/render/mesh_renderers.hpp>

namespace penumbra {

MeshRenderers::MeshRenderers(Backend backend, const std::string& isa, std::size_t most)
    : backend_(backend == Backend::reference ? Backend::reference : Backend::cpu),
      options_{.threads = 1, .isa = isa},
      most_(most) {}

DepthRenderer& MeshRenderers::of(const Meshes& meshes, const Intrinsics& intrinsics) {
  const auto found = std::ranges::find(kept_, meshes, &Kept::meshes);
  if (found != kept_.end()) {
    std::rotate(found, found + 1, kept_.end());
    return *kept_.back().renderer;
  }
  if (kept_.size() == most_) kept_.erase(kept_.begin());
  std::vector<Body> bodies;
  for (const auto& mesh : meshes) bodies.push_back({"mesh", {mesh.get(), 1}});
  return *kept_
              .emplace_back(
                  Kept{meshes, make_depth_renderer(backend_, intrinsics, bodies, options_)})
              .renderer;
}

}  // namespace penumbra
