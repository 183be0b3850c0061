// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>

namespace penumbra {

// Regions: the pixels of a target, also outside the image. A box or polygon that contains no pixel
// centre covers the pixel nearest to its own centre; so does an ellipse without a pixel centre in
// the image.

/// Largest coordinate or length of a region, pixels.
inline constexpr double max_coordinate = 1e9;

/// The pixels whose centres lie in [u, u + width) x [v, v + height).
struct PixelBox {
  double u = 0, v = 0, width = 0, height = 0;
};

/// The pixels whose centres lie inside the outline by the non-zero winding rule. The outline may
/// touch and cross itself. A centre on the outline counts if the inside is to its right or, on a
/// horizontal edge, below it.
struct PixelPolygon {
  static constexpr std::size_t max_corners = 10000;
  std::vector<Eigen::Vector2d> corners;
};

/// The non-zero pixels of an image of the label image's size.
struct PixelMask {
  Shared<ImageView<const std::uint8_t>> mask;
};

/// COCO's run-length mask, column by column from the left, each from the top: alternating runs of
/// pixels outside and inside, starting outside.
struct RunLengthMask {
  int width = 0, height = 0;  ///< of the label image
  std::vector<std::uint32_t> counts;
};

/// The pixels whose centres lie inside an ellipse or on it.
struct PixelEllipse {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes = Eigen::Vector2d::Ones();  ///< pixels, > 0
  double angle = 0;  ///< radians from +u to +v, of the first semi-axis
};

/// An object that was rendered alone: the pixels with depth > 0, metres, which is also the expected
/// depth. Nothing outside the image; always amodal.
struct RenderedRegion {
  static constexpr float max_depth = 1e6f;  ///< metres

  Shared<ImageView<const float>> depth;  ///< of the label image's size
  const TileMask* touched = nullptr;     ///< depth is 0 outside these tiles; null: all are read
};

using Region =
    std::variant<PixelBox, PixelPolygon, PixelMask, RunLengthMask, PixelEllipse, RenderedRegion>;

/// Throws InputError for a region that is invalid in an image of that size.
void check_region(const Region& region, int width, int height);

/// The part of a target that a region covers.
enum class Extent {
  amodal,  ///< all of it, including hidden parts
  modal    ///< the visible part; compared with the whole target as seen before
};

}  // namespace penumbra
