// SPDX-License-Identifier: Apache-2.0
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include <penumbra/pipeline/gl/gl_labeller.hpp>
#include <penumbra/pipeline/gl/label_passes-inl.hpp>
#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_check.hpp>
#include <penumbra/render/gl/open_device.hpp>
#include <penumbra/render/gl/scene.hpp>
#include <penumbra/render/gl/target.hpp>

namespace penumbra {
namespace {

std::string size(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

struct GlLabeller::State {
  State(const Intrinsics& intrinsics, std::span<const Body> bodies, const LabelRule& rule,
        int device_index)
      : width(intrinsics.width()),
        height(intrinsics.height()),
        body_count(bodies.size()),
        context(gl::open_device(device_index)),
        current(std::in_place, *context),
        target(intrinsics),
        scene(intrinsics, bodies, gl::LabelPasses::slots),
        passes(intrinsics.width(), intrinsics.height(), rule) {
    current.reset();
    for (const Body& body : bodies) triangle_count += body.triangle_count();
  }

  /// Throws std::logic_error for what submit() does not take.
  void check(std::span<const Eigen::Isometry3d> T_camera_body, const DepthView& measured,
             std::span<const gl::PixelRectangle> boxes) const;

  int width, height;
  std::size_t body_count;
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
  check_count_of(bodies);
  try {
    state_ = std::make_unique<State>(intrinsics, bodies, rule, options.gl_device);
  } catch (const std::bad_alloc&) {
    gl::refuse_for_memory(intrinsics, bodies);
  }
}

void GlLabeller::State::check(std::span<const Eigen::Isometry3d> T_camera_body,
                              const DepthView& measured,
                              std::span<const gl::PixelRectangle> boxes) const {
  const auto refuse = [](const std::string& what) {
    throw std::logic_error("GlLabeller::submit: " + what);
  };
  if (boxes.size() > max_boxes)
    refuse(std::to_string(boxes.size()) + " boxes; it takes " + std::to_string(max_boxes));
  if (T_camera_body.size() != body_count) {
    refuse(std::to_string(T_camera_body.size()) + " poses for " + std::to_string(body_count) +
           " bodies");
  }
  std::visit(
      [&](const auto& view) {
        if (!view.empty() && view.width == width && view.height == height) return;
        refuse("an image of " +
               (view.data == nullptr ? "no pixels" : size(view.width, view.height)) +
               " for a camera of " + size(width, height));
      },
      measured);
}

GlLabeller::~GlLabeller() = default;

void GlLabeller::submit(std::span<const Eigen::Isometry3d> T_camera_body, const DepthView& measured,
                        std::span<const gl::PixelRectangle> boxes) {
  State& s = *state_;
  if (s.submitted - s.collected == max_pending) {
    throw std::logic_error("GlLabeller::submit: " + std::to_string(max_pending) +
                           " frames are pending; collect one first");
  }
  s.check(T_camera_body, measured, boxes);
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
