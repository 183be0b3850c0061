// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// The OpenGL renderer. `device` as RendererOptions::gl_device.
[[nodiscard]] std::unique_ptr<DepthRenderer> make_gl_renderer(const Intrinsics& intrinsics,
                                                              std::span<const Body> bodies,
                                                              int device);

}  // namespace penumbra
