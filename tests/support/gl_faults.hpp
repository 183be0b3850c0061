// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <penumbra/camera/intrinsics.hpp>

namespace penumbra::test {

/// What may go wrong on a graphics device.
enum class GlFault {
  make_current,  ///< the context cannot be made current
  fetch,         ///< a frame is not read back, which OpenGL notes as an error
  fence,         ///< there is nothing to wait for
  wait,          ///< waiting fails
  patience,      ///< the frame does not come in time
  error,         ///< OpenGL tells of an error
  reset,         ///< the device was reset, and the context with it
};

inline constexpr std::array all_gl_faults{GlFault::make_current, GlFault::fetch,    GlFault::fence,
                                          GlFault::wait,         GlFault::patience, GlFault::error,
                                          GlFault::reset};

[[nodiscard]] std::string to_string(GlFault fault);

/// What fails is drawn with it: rows of odd lengths, which devices pad.
inline const Intrinsics odd_camera(97, 71, 90.0, 90.0, 48.0, 35.0);

/// Lets the device fail once while it lives, at the first use of what fails after `spared` others.
/// One at a time; what is drawn with must have drawn before.
class InjectedFault {
 public:
  explicit InjectedFault(GlFault fault, int spared = 0);
  ~InjectedFault();
  InjectedFault(const InjectedFault&) = delete;
  InjectedFault& operator=(const InjectedFault&) = delete;

  [[nodiscard]] bool happened() const;
};

/// Expects the one line of a renderer that failed for good.
void expect_final(const std::runtime_error& error);

/// Steps of a renderer, none of which may succeed after one that failed.
class Attempts {
 public:
  template <typename Step>
  void operator()(Step&& step) {
    try {
      step();
      EXPECT_FALSE(failed_) << "it failed and went on";
    } catch (const std::runtime_error& error) {
      failed_ = true;
      expect_final(error);
    }
  }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  bool failed_ = false;
};

/// The device cannot be made current while it lives.
class NoDeviceCurrent {
 public:
  NoDeviceCurrent();
  ~NoDeviceCurrent();
  NoDeviceCurrent(const NoDeviceCurrent&) = delete;
  NoDeviceCurrent& operator=(const NoDeviceCurrent&) = delete;
};

}  // namespace penumbra::test
