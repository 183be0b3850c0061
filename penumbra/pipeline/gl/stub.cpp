// SPDX-License-Identifier: Apache-2.0
// Stands for labels with OpenGL where it was not built.
#include <penumbra/pipeline/gl/gl_labeller.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra {

struct GlLabeller::State {
  RendererInfo info;
};

GlLabeller::GlLabeller(const Intrinsics& /*intrinsics*/, std::span<const Body> /*bodies*/,
                       const LabelRule& /*rule*/, const RendererOptions& /*options*/) {
  static_cast<void>(gl_devices());  // throws, and says what to do
}

GlLabeller::~GlLabeller() = default;

void GlLabeller::submit(std::span<const Eigen::Isometry3d> /*T_camera_body*/,
                        const DepthView& /*measured*/,
                        std::span<const gl::PixelRectangle> /*boxes*/) {}

DeviceLabels GlLabeller::collect() { return {}; }

const RendererInfo& GlLabeller::info() const { return state_->info; }
std::size_t GlLabeller::triangle_count() const { return 0; }

}  // namespace penumbra
