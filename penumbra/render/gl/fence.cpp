// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>
#include <utility>

#include <epoxy/gl.h>

#include <penumbra/render/gl/fence.hpp>
#include <penumbra/render/gl/gl_check.hpp>

namespace penumbra::gl {

void wait_for(void*& fence) {
  if (fence == nullptr) return;
  constexpr GLuint64 patience = 60'000'000'000;  // ns; drivers reset what hangs much sooner
  auto* const sync = static_cast<GLsync>(std::exchange(fence, nullptr));
  const GLenum result = glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, patience);
  glDeleteSync(sync);
  check_frame();
  if (result != GL_ALREADY_SIGNALED && result != GL_CONDITION_SATISFIED) {
    throw std::runtime_error("OpenGL: a frame was not done in 60 s: make a new renderer");
  }
}

}  // namespace penumbra::gl
