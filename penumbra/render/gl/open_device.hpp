// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <penumbra/render/gl/egl_context.hpp>

namespace penumbra::gl {

/// A context on the device that RendererOptions::gl_device names. Throws InputError where it cannot
/// be had.
[[nodiscard]] std::unique_ptr<EglContext> open_device(int device);

/// As RendererInfo::device has it.
[[nodiscard]] std::string words_of(const GlDevice& device);

}  // namespace penumbra::gl
