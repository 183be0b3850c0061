// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <optional>
#include <stdexcept>
#include <utility>

#include <penumbra/pipeline/gl/gl_labeller.hpp>
#include <penumbra/pipeline/gl/label_passes-inl.hpp>
#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_check.hpp>
#include <penumbra/render/gl/open_device.hpp>
#include <penumbra/render/gl/scene.hpp>
#include <penumbra/render/gl/target.hpp>

namespace penumbra {

struct GlLabeller::State {
  State(const Intrinsics& intrinsics, std::span<const Body> bodies, const LabelRule& rule,
        int device_index)
      : context(gl::open_device(device_index)),
        current(std::in_place, *context),
        target(intrinsics),
        scene(intrinsics, bodies, gl::LabelPasses::slots),
        passes(intrinsics.width(), intrinsics.height(), rule) {
    current.reset();
    for (const Body& body : bodies) {
      for (const TriangleMesh& mesh : body.meshes) triangle_count += mesh.triangles.size();
    }
  }

  std::unique_ptr<gl::EglContext> context;
  std::optional<gl::EglContext::Current> current;  // while the rest is made
  gl::Target target;
  gl::Scene scene;
  gl::LabelPasses passes;
  RendererInfo info{.backend = Backend::gl, .device = gl::words_of(context->device())};
  gl::FirstFailure first_failure;
  std::size_t triangle_count = 0;
  std::size_t submitted = 0;
  std::size_t collected = 0;
};

GlLabeller::GlLabeller(const Intrinsics& intrinsics, std::span<const Body> bodies,
                       const LabelRule& rule, const RendererOptions& options) {
  rule.check();
  state_ = std::make_unique<State>(intrinsics, bodies, rule, options.gl_device);
}

GlLabeller::~GlLabeller() = default;

void GlLabeller::submit(std::span<const Eigen::Isometry3d> T_camera_body, const DepthView& measured,
                        std::span<const gl::PixelRectangle> boxes) {
  State& s = *state_;
  if (s.submitted - s.collected == max_pending) {
    throw std::logic_error("GlLabeller::submit: " + std::to_string(max_pending) +
                           " frames are pending; collect one first");
  }
  if (boxes.size() > max_boxes) {
    throw std::logic_error("GlLabeller::submit: " + std::to_string(boxes.size()) +
                           " boxes; it takes " + std::to_string(max_boxes));
  }
  s.first_failure.guard([&] {
    const gl::EglContext::Current current(*s.context);
    const std::size_t slot = s.submitted % gl::LabelPasses::slots;
    const gl::PixelRectangle seen = s.scene.place(T_camera_body, slot);
    if (!seen.empty()) {
      s.target.begin(seen);
      s.scene.draw();
    }
    s.passes.start(slot, s.target.depth_image(), seen, measured, boxes);
    gl::check_frame();
    ++s.submitted;
  });
}

DeviceLabels GlLabeller::collect() {
  State& s = *state_;
  if (s.submitted == s.collected)
    throw std::logic_error("GlLabeller::collect: no frame is pending");
  const std::size_t oldest = s.collected++ % gl::LabelPasses::slots;
  return s.first_failure.guard([&] {
    const gl::EglContext::Current current(*s.context);
    return s.passes.wait(oldest);
  });
}

const RendererInfo& GlLabeller::info() const { return state_->info; }
std::size_t GlLabeller::triangle_count() const { return state_->triangle_count; }

}  // namespace penumbra
