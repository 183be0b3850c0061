// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <epoxy/gl.h>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/gl_check.hpp>

namespace penumbra::gl {
namespace {

std::string name_of(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return "error " + std::to_string(error);
  }
}

}  // namespace

std::string text(unsigned name) {
  const GLubyte* const words = glGetString(name);
  return words == nullptr ? "" : reinterpret_cast<const char*>(words);
}

std::string take_error() {
  std::string first;
  // A lost context may answer with an error for ever.
  constexpr int most = 8;
  for (int i = 0; i < most; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    if (first.empty()) first = name_of(error);
  }
  return first;
}

void check_frame() {
  if (glGetGraphicsResetStatus() != GL_NO_ERROR) {
    throw DeviceError("OpenGL: the graphics device was reset");
  }
  const std::string error = take_error();
  if (!error.empty()) throw DeviceError("OpenGL: the frame failed with " + error);
}

void* make_fence() {
  void* const fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (fence == nullptr) {
    throw DeviceError("OpenGL: the frame cannot be waited for (" + take_error() + ")");
  }
  glFlush();
  return fence;
}

void wait_for(void*& fence) {
  if (fence == nullptr) return check_frame();
  constexpr GLuint64 patience = 60'000'000'000;  // ns; drivers reset what hangs much sooner
  auto* const sync = static_cast<GLsync>(std::exchange(fence, nullptr));
  const GLenum result = glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, patience);
  glDeleteSync(sync);
  check_frame();
  if (result != GL_ALREADY_SIGNALED && result != GL_CONDITION_SATISFIED) {
    throw DeviceError("OpenGL: a frame was not done in 60 s");
  }
}

}  // namespace penumbra::gl
