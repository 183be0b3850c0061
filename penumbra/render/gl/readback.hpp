// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::gl {

/// A ring of images in memory that both the device and this process see. All calls need the context
/// that it was made in; its OpenGL objects die with that.
class Readback {
 public:
  static constexpr std::size_t slots = 3;

  /// Throws InputError where the images are larger than the device takes.
  explicit Readback(const Intrinsics& intrinsics);

  /// Begins to fetch a rectangle of the bound framebuffer; what a frame before left outside of it
  /// becomes 0.
  void start(std::size_t slot, const PixelRectangle& rectangle);

  /// Waits until the slot's images are complete. Throws DeviceError where they never will
  /// be.
  [[nodiscard]] VirtualDepthView wait(std::size_t slot);

 private:
  struct Slot {
    PixelRectangle rectangle;  // outside of it all is 0
    TileMask touched;
    void* fence = nullptr;
    float* depth = nullptr;
    std::uint16_t* links = nullptr;
  };

  void clear(Slot& slot, const PixelRectangle& rectangle) const;

  int width_, height_;
  std::size_t stride_;  // pixels
  std::byte* data_ = nullptr;
  std::array<Slot, slots> slots_;
};

}  // namespace penumbra::gl
