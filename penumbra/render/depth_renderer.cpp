// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/render/backends-inl.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
namespace {

std::string too_many(std::size_t given, std::string_view what, std::size_t most) {
  return "the robot has " + std::to_string(given) + " " + std::string(what) +
         "; the renderer takes " + std::to_string(most) + " at the most";
}

/// Throws InputError for more than DepthRenderer::max_bodies or max_drawn_bodies.
void check_count_of(std::span<const Body> bodies) {
  constexpr std::size_t max_drawn = DepthRenderer::max_drawn_bodies;
  constexpr std::size_t max = DepthRenderer::max_bodies;
  const auto drawn = static_cast<std::size_t>(std::count_if(
      bodies.begin(), bodies.end(), [](const Body& body) { return body.triangle_count() > 0; }));
  if (drawn > max_drawn) throw InputError(too_many(drawn, "links to draw", max_drawn));
  if (bodies.size() > max) throw InputError(too_many(bodies.size(), "links", max));
}

}  // namespace

std::string_view to_string(Backend backend) {
  switch (backend) {
    case Backend::cpu:
      return "cpu";
    case Backend::gl:
      return "gl";
    case Backend::reference:
      return "reference";
  }
  return "unknown";
}

std::size_t Body::triangle_count() const {
  std::size_t count = 0;
  for (const PreparedMesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

DepthRenderer::DepthRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies,
                             RendererInfo info, int max_pending)
    : intrinsics_(intrinsics),
      body_count_(bodies.size()),
      info_(std::move(info)),
      max_pending_(max_pending) {
  for (const Body& body : bodies) triangle_count_ += body.triangle_count();
  check_count_of(bodies);
}

VirtualDepthView DepthRenderer::render(std::span<const Eigen::Isometry3d> T_camera_body) {
  return render(T_camera_body, {0, 0, intrinsics_.width(), intrinsics_.height()});
}

VirtualDepthView DepthRenderer::render(std::span<const Eigen::Isometry3d> T_camera_body,
                                       const PixelRectangle& window) {
  if (pending_ > 0) {
    throw std::logic_error("render: " + std::to_string(pending_) +
                           " submitted frames are not collected yet");
  }
  submit(T_camera_body, window);
  return collect();
}

void DepthRenderer::submit(std::span<const Eigen::Isometry3d> T_camera_body) {
  submit(T_camera_body, {0, 0, intrinsics_.width(), intrinsics_.height()});
}

void DepthRenderer::submit(std::span<const Eigen::Isometry3d> T_camera_body,
                           const PixelRectangle& window) {
  if (T_camera_body.size() != body_count_) {
    throw std::logic_error("submit: " + std::to_string(T_camera_body.size()) + " poses for " +
                           std::to_string(body_count_) + " bodies");
  }
  if (pending_ == max_pending_) {
    throw std::logic_error("submit: " + std::to_string(pending_) +
                           " frames are pending, the most there may be: collect one first");
  }
  do_submit(T_camera_body, window);
  ++pending_;
}

VirtualDepthView DepthRenderer::collect() {
  if (pending_ == 0) throw std::logic_error("collect: no frame was submitted");
  --pending_;
  return do_collect();
}

std::unique_ptr<DepthRenderer> make_depth_renderer(Backend backend, const Intrinsics& intrinsics,
                                                   std::span<const Body> bodies,
                                                   const RendererOptions& options) {
  switch (backend) {
    case Backend::cpu:
      return make_cpu_renderer(intrinsics, bodies, options);
    case Backend::gl:
      return make_gl_renderer(intrinsics, bodies, options.gl_device);
    case Backend::reference:
      return make_reference_renderer(intrinsics, bodies);
  }
  throw InputError("unknown renderer");
}

}  // namespace penumbra
