// SPDX-License-Identifier: Apache-2.0
// Faults come in through the pointers by which libepoxy calls OpenGL's functions.
#include "gl_faults.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// Every function through which a fault can come, as libepoxy found it.
struct Functions {
  decltype(epoxy_eglMakeCurrent) make_current = epoxy_eglMakeCurrent;
  decltype(epoxy_glReadPixels) read_pixels = epoxy_glReadPixels;
  decltype(epoxy_glFenceSync) fence_sync = epoxy_glFenceSync;
  decltype(epoxy_glClientWaitSync) client_wait = epoxy_glClientWaitSync;
  decltype(epoxy_glGetError) get_error = epoxy_glGetError;
  decltype(epoxy_glGetGraphicsResetStatus) reset_status = epoxy_glGetGraphicsResetStatus;

  void use() const {
    epoxy_eglMakeCurrent = make_current;
    epoxy_glReadPixels = read_pixels;
    epoxy_glFenceSync = fence_sync;
    epoxy_glClientWaitSync = client_wait;
    epoxy_glGetError = get_error;
    epoxy_glGetGraphicsResetStatus = reset_status;
  }
};

Functions real;
GlFault wanted{};
int left = 0;  // uses that are spared

bool fails(GlFault fault) { return fault == wanted && left-- == 0; }

constexpr GLenum nonsense = 0xdead;

EGLBoolean make_current(EGLDisplay display, EGLSurface draw, EGLSurface read, EGLContext context) {
  if (context != EGL_NO_CONTEXT && fails(GlFault::make_current)) return EGL_FALSE;
  return real.make_current(display, draw, read, context);
}

EGLBoolean never_current(EGLDisplay display, EGLSurface draw, EGLSurface read, EGLContext context) {
  if (context != EGL_NO_CONTEXT) return EGL_FALSE;
  return real.make_current(display, draw, read, context);
}

void read_pixels(GLint u, GLint v, GLsizei width, GLsizei height, GLenum format, GLenum type,
                 void* at) {
  real.read_pixels(u, v, width, height, fails(GlFault::fetch) ? nonsense : format, type, at);
}

GLsync fence_sync(GLenum condition, GLbitfield flags) {
  return fails(GlFault::fence) ? nullptr : real.fence_sync(condition, flags);
}

GLenum client_wait(GLsync sync, GLbitfield flags, GLuint64 patience) {
  if (fails(GlFault::wait)) return GL_WAIT_FAILED;
  if (fails(GlFault::patience)) return GL_TIMEOUT_EXPIRED;
  return real.client_wait(sync, flags, patience);
}

GLenum get_error() { return fails(GlFault::error) ? GL_OUT_OF_MEMORY : real.get_error(); }

GLenum reset_status() {
  return fails(GlFault::reset) ? GL_UNKNOWN_CONTEXT_RESET : real.reset_status();
}

}  // namespace

void expect_final(const std::runtime_error& error) {
  const std::string message = error.what();
  EXPECT_NE(message.find("; a new renderer is needed"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::string to_string(GlFault fault) {
  constexpr std::array names{"make_current", "fetch", "fence", "wait",
                             "patience",     "error", "reset"};
  return names.at(static_cast<std::size_t>(fault));
}

InjectedFault::InjectedFault(GlFault fault, int spared) {
  real = Functions();
  wanted = fault;
  left = spared;
  Functions{make_current, read_pixels, fence_sync, client_wait, get_error, reset_status}.use();
}

InjectedFault::~InjectedFault() { real.use(); }

bool InjectedFault::happened() const { return left < 0; }

NoDeviceCurrent::NoDeviceCurrent() {
  real = Functions();
  Functions current = real;
  current.make_current = never_current;
  current.use();
}

NoDeviceCurrent::~NoDeviceCurrent() { real.use(); }

}  // namespace penumbra::test
