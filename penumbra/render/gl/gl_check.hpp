// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

#include <penumbra/base/error.hpp>

namespace penumbra::gl {

/// One of OpenGL's own strings, GL_RENDERER for instance; empty where it has none.
[[nodiscard]] std::string text(unsigned name);

/// Name of the oldest error that OpenGL remembers, all of which it then forgets; empty: none.
[[nodiscard]] std::string take_error();

/// Throws DeviceError if the current context was lost or remembers an error: what it drew is
/// then not to be trusted.
void check_frame();

/// Hands all that was called so far to the device. Returns a GLsync of the current context that
/// comes when it is done. Throws DeviceError where the context gives none.
[[nodiscard]] void* make_fence();

/// Waits for a GLsync of the current context, deletes it and makes it null; null is there already.
/// Throws DeviceError where it never comes or the context fails.
void wait_for(void*& fence);

/// Remembers the first failure of a context. OpenGL does not tell to which of the pending frames an
/// error belongs, so that after one none of them is to be trusted.
class FirstFailure {
 public:
  /// Does a step and returns what it does. Throws DeviceError where this step or one before
  /// has failed.
  template <typename Step>
  auto guard(Step&& step) {
    if (what_.empty()) {
      try {
        return step();
      } catch (const std::exception& error) {
        what_ = error.what();
      }
    }
    throw DeviceError(what_ + "; a new renderer is needed");
  }

 private:
  std::string what_;
};

}  // namespace penumbra::gl
