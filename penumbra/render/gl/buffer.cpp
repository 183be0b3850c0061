// SPDX-License-Identifier: Apache-2.0
#include <cassert>

#include <epoxy/gl.h>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/buffer.hpp>
#include <penumbra/render/gl/gl_check.hpp>

namespace penumbra::gl {

unsigned make_buffer(std::size_t bytes, const void* data, unsigned flags, const std::string& what,
                     std::byte** mapped) {
  assert(((flags & GL_MAP_PERSISTENT_BIT) != 0) == (mapped != nullptr));
  const auto size = static_cast<GLsizeiptr>(bytes);
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferStorage(buffer, size, data, flags);
  std::string error = take_error();
  if (error.empty() && mapped != nullptr) {
    constexpr GLbitfield access =
        GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    *mapped = static_cast<std::byte*>(glMapNamedBufferRange(buffer, 0, size, flags & access));
    error = take_error();
    if (*mapped == nullptr && error.empty()) error = "it cannot be mapped";
  }
  if (error.empty()) return buffer;
  throw InputError("renderer 'gl': " + std::to_string((bytes + 999'999) / 1'000'000) + " MB for " +
                   what + " are more than " + text(GL_RENDERER) + " gives (" + error +
                   "); make it less or use the renderer 'cpu'");
}

}  // namespace penumbra::gl
