// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_check.hpp>
#include <penumbra/render/gl/gl_renderer.hpp>
#include <penumbra/render/gl/open_device.hpp>
#include <penumbra/render/gl/readback.hpp>
#include <penumbra/render/gl/scene.hpp>
#include <penumbra/render/gl/target.hpp>

namespace penumbra {
namespace {

using gl::EglContext;

class GlRenderer final : public DepthRenderer {
 public:
  GlRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies,
             std::unique_ptr<EglContext> context)
      : DepthRenderer(intrinsics, bodies,
                      {.backend = Backend::gl, .device = gl::words_of(context->device())},
                      gl::Readback::slots),
        context_(std::move(context)),
        drawing_(*context_, intrinsics, bodies) {}

 private:
  void do_submit(std::span<const Eigen::Isometry3d> T_camera_body) override {
    first_failure_.guard([&] {
      const EglContext::Current current(*context_);
      const gl::PixelRectangle seen = drawing_.scene.place(T_camera_body, next_);
      if (!seen.empty()) {
        drawing_.target.begin(seen);
        drawing_.scene.draw();
      }
      drawing_.readback.start(next_, seen);
      gl::check_frame();
      next_ = (next_ + 1) % gl::Readback::slots;
    });
  }

  VirtualDepthView do_collect() override {
    const std::size_t oldest = std::exchange(oldest_, (oldest_ + 1) % gl::Readback::slots);
    return first_failure_.guard([&] {
      const EglContext::Current current(*context_);
      return drawing_.readback.wait(oldest);
    });
  }

  /// Made while the context is current.
  struct Drawing {
    Drawing(const EglContext& context, const Intrinsics& intrinsics, std::span<const Body> bodies)
        : current(std::in_place, context),
          target(intrinsics),
          scene(intrinsics, bodies, gl::Readback::slots),
          readback(intrinsics) {
      current.reset();
    }
    std::optional<EglContext::Current> current;
    gl::Target target;
    gl::Scene scene;
    gl::Readback readback;
  };

  std::unique_ptr<EglContext> context_;
  Drawing drawing_;
  gl::FirstFailure first_failure_;
  std::size_t next_ = 0;
  std::size_t oldest_ = 0;
};

}  // namespace

std::unique_ptr<DepthRenderer> make_gl_renderer(const Intrinsics& intrinsics,
                                                std::span<const Body> bodies, int device) {
  try {
    return std::make_unique<GlRenderer>(intrinsics, bodies, gl::open_device(device));
  } catch (const std::bad_alloc&) {
    gl::refuse_for_memory(intrinsics, bodies);
  }
}

}  // namespace penumbra
