// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <epoxy/egl.h>

#include <penumbra/base/error.hpp>

#include <sim/egl_context.hpp>

namespace penumbra::sim {
namespace {

[[noreturn]] void refuse_egl(const std::string& what) {
  throw InputError("simulation: " + what +
                   "; install libegl1, libopengl0 and a driver (Mesa's: libegl-mesa0 "
                   "libgl1-mesa-dri; or the GPU vendor's)");
}

/// Opens the EGL display. Displays belong to the whole process, so it is opened once and never
/// closed.
EGLDisplay open_egl_display() {
  // MuJoCo reads from this variable where to find OpenGL's functions. The user's value is kept.
  setenv("MUJOCO_GL", "egl", 0);
  if (!epoxy_has_egl()) refuse_egl("the library libEGL.so.1 cannot be loaded");
  const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const auto query =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  if (get == nullptr) refuse_egl("EGL has no eglGetPlatformDisplayEXT");
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (query != nullptr && query(16, devices.data(), &count) != EGL_TRUE) count = 0;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDisplay display =
        get(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE)
      return display;
  }
  const EGLDisplay display = get(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE)
    refuse_egl("EGL offers no device and no drawing without a display");
  return display;
}

}  // namespace

EglContext::EglContext() {
  static const EGLDisplay display = open_egl_display();
  display_ = display;
  const EGLenum api = eglQueryAPI();
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) refuse_egl("EGL has no desktop OpenGL");
  constexpr std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                         EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display_, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0)
    config = nullptr;
  // Without a requested version the context also has the old functions.
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
  eglBindAPI(api);
  if (context_ == EGL_NO_CONTEXT) refuse_egl("EGL gives no OpenGL context");
}

EglContext::~EglContext() { eglDestroyContext(display_, context_); }

EglContext::Current::Current(const EglContext& context)
    : display_(context.display_),
      previous_display_(eglGetCurrentDisplay()),
      previous_context_(eglGetCurrentContext()),
      previous_draw_(eglGetCurrentSurface(EGL_DRAW)),
      previous_read_(eglGetCurrentSurface(EGL_READ)),
      previous_api_(eglQueryAPI()) {
  eglBindAPI(EGL_OPENGL_API);
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_) != EGL_TRUE) {
    eglBindAPI(previous_api_);
    throw std::runtime_error("simulation: the OpenGL context cannot be used");
  }
}

EglContext::Current::~Current() {
  if (previous_context_ == EGL_NO_CONTEXT)
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  else
    eglMakeCurrent(previous_display_, previous_draw_, previous_read_, previous_context_);
  eglBindAPI(previous_api_);
}

}  // namespace penumbra::sim
