// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/render/depth_renderer.hpp>

#include <io/files/json-inl.hpp>

namespace penumbra::io {

/// "renderer" of report.json.
[[nodiscard]] Json renderer_json(const RendererInfo& info);

}  // namespace penumbra::io
