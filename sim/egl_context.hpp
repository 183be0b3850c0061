// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::sim {

/// An OpenGL context without a display, with the fixed functions that MuJoCo's renderer needs.
class EglContext {
 public:
  /// Throws InputError that says what to install if no context can be made.
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes the context current in this thread for its lifetime, then restores the previous one.
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
