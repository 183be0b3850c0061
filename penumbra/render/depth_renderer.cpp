// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/render/cpu/cpu_renderer.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/reference.hpp>

namespace penumbra {

std::string_view to_string(Backend backend) {
  return backend == Backend::cpu ? "cpu" : "reference";
}

DepthRenderer::DepthRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies,
                             RendererInfo info)
    : intrinsics_(intrinsics), body_count_(bodies.size()), info_(std::move(info)) {
  if (bodies.size() > max_bodies) {
    throw InputError("the robot has " + std::to_string(bodies.size()) +
                     " links; the renderer takes " + std::to_string(max_bodies) + " at the most");
  }
  for (const Body& body : bodies) {
    for (const TriangleMesh& mesh : body.meshes) triangle_count_ += mesh.triangles.size();
  }
}

VirtualDepthView DepthRenderer::render(std::span<const Eigen::Isometry3d> T_camera_body) {
  assert(T_camera_body.size() == body_count_);
  return do_render(T_camera_body);
}

std::unique_ptr<DepthRenderer> make_depth_renderer(Backend backend, const Intrinsics& intrinsics,
                                                   std::span<const Body> bodies,
                                                   const RendererOptions& options) {
  switch (backend) {
    case Backend::cpu:
      return make_cpu_renderer(intrinsics, bodies, options);
    case Backend::reference:
      return make_reference_renderer(intrinsics, bodies);
  }
  throw InputError("unknown renderer");
}

}  // namespace penumbra
