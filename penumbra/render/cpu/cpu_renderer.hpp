// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// The SIMD renderer. Throws as make_depth_renderer does.
[[nodiscard]] std::unique_ptr<DepthRenderer> make_cpu_renderer(const Intrinsics& intrinsics,
                                                               std::span<const Body> bodies,
                                                               const RendererOptions& options);

}  // namespace penumbra
