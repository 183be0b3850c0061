// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::sim {

/// An OpenGL context with the fixed functions that MuJoCo's renderer needs, without a display.
class EglContext {
 public:
  /// Throws InputError, and says what to install, where it cannot be had.
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes the context current in this thread while it lives, and then again whatever was before.
  class Current {
   public:
    explicit Current(const EglContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    void* display_;
    void* previous_display_;
    void* previous_context_;
    void* previous_draw_;
    void* previous_read_;
    unsigned previous_api_;
  };

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace penumbra::sim
