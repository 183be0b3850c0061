// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::gl {

/// Which functions a context has.
enum class GlProfile {
  core,   ///< OpenGL 4.5 core
  legacy  ///< the old ones too, of any version
};

/// An OpenGL context without a surface, on one device. EGL's displays belong to the whole
/// process: they are opened once and never closed, since other code may draw on the same ones.
class EglContext {
 public:
  /// Number of devices that EGL offers. Throws InputError where there is no EGL.
  [[nodiscard]] static std::size_t device_count();

  /// Throws InputError if the profile cannot be had on device `index`.
  explicit EglContext(std::size_t index, GlProfile profile = GlProfile::core);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// In OpenGL's own words.
  [[nodiscard]] const GlDevice& device() const { return device_; }

  /// Makes the context current in this thread while it lives, and then again whatever was before:
  /// the thread's own drawing is left alone, and a renderer may move between threads.
  class Current {
   public:
    /// Throws DeviceError if the context was lost.
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
  GlDevice device_;
};

/// Returns a context on the device that RendererOptions::gl_device names. Throws InputError if it
/// cannot be had.
[[nodiscard]] std::unique_ptr<EglContext> open_device(int device,
                                                      GlProfile profile = GlProfile::core);

}  // namespace penumbra::gl
