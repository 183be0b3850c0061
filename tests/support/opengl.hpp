// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "required.hpp"

#include <cstddef>
#include <optional>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {

/// Returns the first of gl_devices() that can draw; fails the test if OpenGL is_required() and none
/// can.
inline std::optional<std::size_t> working_device() {
  static const auto device = []() -> std::optional<std::size_t> {
    try {
      const std::vector<GlDevice> devices = gl_devices();
      for (std::size_t i = 0; i < devices.size(); ++i)
        if (devices[i].fault.empty()) return i;
      return std::nullopt;
    } catch (const InputError&) {
      return std::nullopt;
    }
  }();
  static_cast<void>(is_there(device.has_value(), "opengl"));
  return device;
}

/// Returns whether a device of gl_devices() can draw. If not, tests are skipped or shortened,
/// unless OpenGL is_required().
inline bool has_opengl() { return working_device().has_value(); }

/// Returns whether this machine can draw with the backend; only OpenGL may be missing.
inline bool can_draw(Backend backend) { return backend != Backend::gl || has_opengl(); }

inline constexpr const char* no_opengl = "skipped: no OpenGL";

/// A test for each backend.
class BackendTest : public ::testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (!can_draw(GetParam())) GTEST_SKIP() << no_opengl;
  }
};

}  // namespace penumbra::test

#define PENUMBRA_BACKEND_TEST(suite)                                                         \
  class suite : public penumbra::test::BackendTest {};                                       \
  INSTANTIATE_TEST_SUITE_P(Backends, suite,                                                  \
                           ::testing::Values(Backend::cpu, Backend::gl, Backend::reference), \
                           [](const auto& test) { return std::string(to_string(test.param)); })
