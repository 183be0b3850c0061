// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/render/backends-inl.hpp>
#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_calls.hpp>
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
                      {.backend = Backend::gl,
                       .device = context->device().name + ", OpenGL " + context->device().version},
                      gl::Readback::slots),
        context_(std::move(context)),
        drawing_(*context_, intrinsics, bodies) {}

 private:
  /// Does a step and returns its result. Throws DeviceError if this or an earlier step failed:
  /// OpenGL does not tell which pending frame an error belongs to, so all are invalid then.
  template <typename Step>
  auto guarded(Step&& step) {
    if (failure_.empty()) {
      try {
        return step();
      } catch (const std::exception& error) {
        failure_ = error.what();
      }
    }
    throw DeviceError(failure_ + "; a new renderer is needed");
  }

  void do_submit(std::span<const Eigen::Isometry3d> T_camera_body,
                 const PixelRectangle& /*window*/) override {
    guarded([&] {
      const EglContext::Current current(*context_);
      const PixelRectangle seen = drawing_.scene.place(T_camera_body, next_);
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
    return guarded([&] {
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
  std::string failure_;  // the first
  std::size_t next_ = 0;
  std::size_t oldest_ = 0;
};

}  // namespace

std::unique_ptr<DepthRenderer> make_gl_renderer(const Intrinsics& intrinsics,
                                                std::span<const Body> bodies, int device) {
  try {
    return std::make_unique<GlRenderer>(intrinsics, bodies, gl::open_device(device));
  } catch (const std::bad_alloc&) {
    std::size_t triangles = 0;
    for (const Body& body : bodies) triangles += body.triangle_count();
    throw InputError("renderer 'gl': a robot of " + std::to_string(triangles) +
                     " triangles and an image of " + std::to_string(intrinsics.width()) + " x " +
                     std::to_string(intrinsics.height()) +
                     " pixels need more memory than this machine gives; use coarser meshes or a "
                     "smaller image");
  }
}

}  // namespace penumbra
