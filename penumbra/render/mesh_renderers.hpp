// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// Renderers of meshes that are not the robot's, each on one thread of the CPU. The last ones are
/// kept, so that what is drawn again costs nothing.
class MeshRenderers {
 public:
  using Meshes = std::vector<std::shared_ptr<const PreparedMesh>>;

  /// `backend`: the robot's. `most`: renderers that are kept, of 14 MB each at 1280x720.
  MeshRenderers(Backend backend, const std::string& isa, std::size_t most);

  /// Returns the renderer of these meshes in an image, each a body; valid until the next call.
  DepthRenderer& of(const Meshes& meshes, const Intrinsics& intrinsics);

 private:
  struct Kept {
    Meshes meshes;
    std::unique_ptr<DepthRenderer> renderer;
  };
  Backend backend_;
  RendererOptions options_;
  std::size_t most_;
  std::vector<Kept> kept_;  // the last used one at the end
};

}  // namespace penumbra
