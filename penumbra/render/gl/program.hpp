// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

namespace penumbra::gl {

/// A shader of OpenGL's kind `kind`.
struct ShaderSource {
  unsigned kind;
  const char* text;
};

/// Makes a program of the current context and returns its name. Throws std::runtime_error, with the
/// driver's words, where it does not compile or link.
[[nodiscard]] unsigned make_program(std::initializer_list<ShaderSource> shaders);

}  // namespace penumbra::gl
