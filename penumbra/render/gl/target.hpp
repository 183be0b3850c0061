// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/camera/camera.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::gl {

/// Draws into images of metres and links. All calls need the context that it was made in; its
/// OpenGL objects die with that.
class Target {
 public:
  /// Throws InputError where the image is larger than the device takes.
  explicit Target(const Intrinsics& intrinsics);

  /// Confines drawing to a rectangle and clears it.
  void begin(const PixelRectangle& rectangle) const;

 private:
  void make_images(int width, int height);

  unsigned framebuffer_ = 0;
  unsigned program_ = 0;
};

}  // namespace penumbra::gl
