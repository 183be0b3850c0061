// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace penumbra::gl {

/// One of OpenGL's own strings, GL_RENDERER for instance; empty where it has none.
[[nodiscard]] std::string text(unsigned name);

/// Name of the oldest error that OpenGL remembers, all of which it then forgets; empty: none.
[[nodiscard]] std::string take_error();

/// Throws std::runtime_error if the current context was lost or remembers an error: what it drew is
/// then not to be trusted.
void check_frame();

/// Waits for a GLsync of the current context, deletes it and makes it null; null is there already.
/// Throws std::runtime_error where it never comes or the context fails.
void wait_for(void*& fence);

}  // namespace penumbra::gl
