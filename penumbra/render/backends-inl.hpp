// SPDX-License-Identifier: Apache-2.0
// The renderers of make_depth_renderer, which throw as it does.
#pragma once

#include <memory>
#include <span>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// The SIMD renderer.
[[nodiscard]] std::unique_ptr<DepthRenderer> make_cpu_renderer(const Intrinsics& intrinsics,
                                                               std::span<const Body> bodies,
                                                               const RendererOptions& options);

/// The OpenGL renderer. `device` as RendererOptions::gl_device.
[[nodiscard]] std::unique_ptr<DepthRenderer> make_gl_renderer(const Intrinsics& intrinsics,
                                                              std::span<const Body> bodies,
                                                              int device);

/// The plain scalar twin of the SIMD renderer: double precision, no clipping, no culling.
[[nodiscard]] std::unique_ptr<DepthRenderer> make_reference_renderer(const Intrinsics& intrinsics,
                                                                     std::span<const Body> bodies);

}  // namespace penumbra
