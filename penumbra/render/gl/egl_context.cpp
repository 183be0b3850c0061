// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_calls.hpp>

namespace penumbra::gl {
namespace {

constexpr const char* remedy =
    "install libegl1, libopengl0 and a driver (Mesa's: libegl-mesa0 libgl1-mesa-dri; or the GPU "
    "vendor's), or choose the renderer 'cpu'";

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("renderer 'gl': " + what + "; " + remedy);
}

bool has_word(const char* words, std::string_view word) {
  std::string_view rest = words == nullptr ? "" : words;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == word) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::string egl_error() {
  constexpr std::array<std::string_view, 15> names{
      "EGL_SUCCESS",       "EGL_NOT_INITIALIZED",     "EGL_BAD_ACCESS",
      "EGL_BAD_ALLOC",     "EGL_BAD_ATTRIBUTE",       "EGL_BAD_CONFIG",
      "EGL_BAD_CONTEXT",   "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
      "EGL_BAD_MATCH",     "EGL_BAD_NATIVE_PIXMAP",   "EGL_BAD_NATIVE_WINDOW",
      "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",         "EGL_CONTEXT_LOST"};
  const auto code = static_cast<std::size_t>(eglGetError() - EGL_SUCCESS);
  return std::string(code < names.size() ? names[code] : "an unknown EGL error");
}

/// Whether a library can be loaded; it then stays so.
bool loads(const char* library) { return dlopen(library, RTLD_LAZY | RTLD_LOCAL) != nullptr; }

/// libepoxy ends the process where it misses a library, so that they are sought before.
std::string missing_library() {
  if (!epoxy_has_egl()) return "the library libEGL.so.1 cannot be loaded";
  if (loads("libOpenGL.so.0") || loads("libGL.so.1")) return "";
  return "neither libOpenGL.so.0 nor libGL.so.1 can be loaded";
}

void require_libraries() {
  static const std::string missing = missing_library();
  if (!missing.empty()) refuse(missing);
}

/// Functions of extensions, which libepoxy would end the process for.
template <typename Function>
Function find(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// EGL's devices; a single null where it only has Mesa's platform without surfaces.
std::vector<EGLDeviceEXT> devices() {
  require_libraries();
  const char* const extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool enumerates = has_word(extensions, "EGL_EXT_device_base") ||
                          has_word(extensions, "EGL_EXT_device_enumeration");
  if (enumerates && has_word(extensions, "EGL_EXT_platform_device")) {
    const auto query = find<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLint count = 0;
    std::vector<EGLDeviceEXT> all;
    if (query != nullptr && query(0, nullptr, &count) == EGL_TRUE && count > 0) {
      all.resize(static_cast<std::size_t>(count));
      if (query(count, all.data(), &count) == EGL_TRUE) {
        all.resize(static_cast<std::size_t>(count));
        return all;
      }
    }
  }
  if (has_word(extensions, "EGL_MESA_platform_surfaceless")) return {nullptr};
  refuse("EGL offers no device and no drawing without a display");
}

EGLDisplay open_display(EGLDeviceEXT device) {
  const auto get = find<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get == nullptr) refuse("EGL has no eglGetPlatformDisplayEXT");
  const EGLDisplay display = device != nullptr
                                 ? get(EGL_PLATFORM_DEVICE_EXT, device, nullptr)
                                 : get(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    refuse("the device's driver does not start (" + egl_error() + ")");
  }
  const char* const extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!has_word(extensions, "EGL_KHR_surfaceless_context")) {
    refuse("the device's driver lacks EGL_KHR_surfaceless_context");
  }
  return display;
}

EGLConfig choose_config(EGLDisplay display, const char* extensions) {
  if (has_word(extensions, "EGL_KHR_no_config_context")) return nullptr;
  constexpr std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                         EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
    refuse("the device's driver has no OpenGL");
  }
  return config;
}

EGLContext create_context(EGLDisplay display, GlProfile profile) {
  const char* const extensions = eglQueryString(display, EGL_EXTENSIONS);
  const EGLConfig config = choose_config(display, extensions);
  if (profile == GlProfile::legacy) {
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
    if (context == EGL_NO_CONTEXT) refuse("EGL gives no OpenGL context (" + egl_error() + ")");
    return context;
  }
  // With notification of resets, a frame that one spoilt is an error and not an image.
  constexpr std::array with_resets{EGL_CONTEXT_MAJOR_VERSION,
                                   4,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   5,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                   EGL_LOSE_CONTEXT_ON_RESET,
                                   EGL_NONE};
  auto without = with_resets;
  without[6] = EGL_NONE;
  for (const auto& attributes : {with_resets, without})
    if (const EGLContext context =
            eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
        context != EGL_NO_CONTEXT)
      return context;
  refuse("OpenGL 4.5 is needed, and the device does not have it (" + egl_error() + ")");
}

bool draws_on_the_cpu(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer"}) {
    if (renderer.find(name) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

std::size_t EglContext::device_count() { return devices().size(); }

EglContext::EglContext(std::size_t index, GlProfile profile) {
  const std::vector<EGLDeviceEXT> all = devices();
  if (index >= all.size()) {
    throw InputError("renderer 'gl': there is no device " + std::to_string(index) +
                     "; EGL offers " + std::to_string(all.size()) + ", counted from 0");
  }
  const EGLenum api = eglQueryAPI();
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) refuse("EGL has no desktop OpenGL");
  try {
    display_ = open_display(all[index]);
    context_ = create_context(display_, profile);
    std::optional<Current> current;
    try {
      current.emplace(*this);
    } catch (const std::runtime_error& error) {
      refuse(error.what());
    }
    device_.name = text(GL_RENDERER);
    device_.version = text(GL_VERSION);
    device_.vendor = text(GL_VENDOR);
    device_.software = draws_on_the_cpu(device_.name);
  } catch (...) {
    if (context_ != nullptr) eglDestroyContext(display_, context_);
    eglBindAPI(api);
    throw;
  }
  eglBindAPI(api);
}

EglContext::~EglContext() { eglDestroyContext(display_, context_); }

EglContext::Current::Current(const EglContext& context)
    : display_(context.display_),
      previous_display_(eglGetCurrentDisplay()),
      previous_context_(eglGetCurrentContext()),
      previous_draw_(eglGetCurrentSurface(EGL_DRAW)),
      previous_read_(eglGetCurrentSurface(EGL_READ)),
      previous_api_(eglQueryAPI()) {
  if (previous_api_ != EGL_OPENGL_API) eglBindAPI(EGL_OPENGL_API);
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_) != EGL_TRUE) {
    const std::string why = egl_error();
    if (previous_api_ != EGL_OPENGL_API) eglBindAPI(previous_api_);
    throw DeviceError("OpenGL: the context cannot be used (" + why +
                      "): another thread draws with it, or the device was lost");
  }
}

EglContext::Current::~Current() {
  if (previous_context_ == EGL_NO_CONTEXT) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  } else {
    eglMakeCurrent(previous_display_, previous_draw_, previous_read_, previous_context_);
  }
  if (previous_api_ != EGL_OPENGL_API) eglBindAPI(previous_api_);
}

}  // namespace penumbra::gl
