// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/renderer_choice.hpp>

namespace penumbra {

/// Lets both renderers draw the bodies side by side before the camera, moving every frame, and
/// takes the one that needs less wall time per frame. Throws std::runtime_error where their images
/// do not agree, and what the renderers throw.
[[nodiscard]] RendererChoice race(DepthRenderer& cpu, DepthRenderer& gl,
                                  std::span<const Body> bodies);

}  // namespace penumbra
