// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace penumbra {

/// One device on which OpenGL may draw without a display, in OpenGL's own words.
struct GlDevice {
  std::string name;       ///< GL_RENDERER
  std::string version;    ///< GL_VERSION
  std::string vendor;     ///< GL_VENDOR
  bool software = false;  ///< draws on the CPU
  std::string fault;      ///< why it cannot be used; empty: it can
};

/// What EGL offers here, in the order of its own device list (an index into this list is
/// RendererOptions::gl_device). Throws InputError where this build has no OpenGL or the machine no
/// EGL, and says what to install.
[[nodiscard]] std::vector<GlDevice> gl_devices();

}  // namespace penumbra
