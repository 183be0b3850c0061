// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// The plain scalar twin of the SIMD renderer: double precision, no clipping, no culling.
[[nodiscard]] std::unique_ptr<DepthRenderer> make_reference_renderer(const Intrinsics& intrinsics,
                                                                     std::span<const Body> bodies);

}  // namespace penumbra
