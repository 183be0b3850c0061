// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/gl/egl_context.hpp>

namespace penumbra::gl {

/// A context on the device that RendererOptions::gl_device names. Throws InputError where it cannot
/// be had.
[[nodiscard]] std::unique_ptr<EglContext> open_device(int device);

/// As RendererInfo::device has it.
[[nodiscard]] std::string words_of(const GlDevice& device);

/// For std::bad_alloc while a renderer is made: throws InputError, which says what is so large.
[[noreturn]] void refuse_for_memory(const Intrinsics& intrinsics, std::span<const Body> bodies);

}  // namespace penumbra::gl
