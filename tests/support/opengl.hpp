// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "required.hpp"

#include <algorithm>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {

/// Whether some device of gl_devices() can draw; where none does, the tests that ask are skipped or
/// try less, unless OpenGL is_required().
inline bool has_opengl() {
  static const bool answer = [] {
    try {
      const std::vector<GlDevice> devices = gl_devices();
      return std::any_of(devices.begin(), devices.end(),
                         [](const GlDevice& device) { return device.fault.empty(); });
    } catch (const InputError&) {
      return false;
    }
  }();
  return is_there(answer, "opengl");
}

/// Whether this machine can draw with the backend; if not, it is for want of OpenGL.
inline bool can_draw(Backend backend) { return backend != Backend::gl || has_opengl(); }

inline constexpr const char* no_opengl = "skipped: no OpenGL";

}  // namespace penumbra::test
