// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/render/gl/pixel_rectangle.hpp>

namespace penumbra::gl {

/// Draws into images of metres and links. All calls need the context that it was made in; its
/// OpenGL objects die with that.
class Target {
 public:
  /// Throws InputError where the image is larger than the device takes.
  explicit Target(const Intrinsics& intrinsics);

  /// Confines drawing to a rectangle and clears it.
  void begin(const PixelRectangle& rectangle) const;

  /// The texture of metres; beside the last rectangle it is old.
  [[nodiscard]] unsigned depth_image() const { return images_[0]; }

 private:
  void make_images(int width, int height);

  unsigned framebuffer_ = 0;
  std::array<unsigned, 2> images_{};  // textures: metres, links
  unsigned program_ = 0;
};

}  // namespace penumbra::gl
