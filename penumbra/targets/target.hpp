// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>

namespace penumbra {

// Regions: which pixels a target covers. They may lie outside the image, in part or whole. A box or
// polygon that holds no pixel's centre covers the pixel next to its middle, and so does an ellipse
// that holds none of the image.

/// Largest coordinate or length of a region, pixels.
inline constexpr double max_coordinate = 1e9;

/// The pixels whose centres lie in [u, u + width) x [v, v + height).
struct PixelBox {
  double u = 0, v = 0, width = 0, height = 0;
};

/// The pixels whose centres the outline winds around, once or more, in either direction (non-zero
/// winding). The outline may touch and cross itself. A centre on the outline counts where the
/// inside lies to its right or, on a level edge, below.
struct PixelPolygon {
  static constexpr std::size_t max_corners = 10000;
  std::span<const Eigen::Vector2d> corners;
};

/// The pixels that are not 0 in an image of the label image's size.
struct PixelMask {
  ImageView<const std::uint8_t> mask;
};

/// COCO's run-length mask: columns from top to bottom, from left to right; runs of pixels outside
/// and inside by turns, the first of them outside.
struct RunLengthMask {
  int width = 0, height = 0;  ///< of the label image
  std::span<const std::uint32_t> counts;
};

/// The pixels whose centres lie inside an ellipse or on it.
struct PixelEllipse {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes = Eigen::Vector2d::Ones();  ///< pixels, > 0
  double angle = 0;  ///< radians from +u to +v: of the first semi-axis
};

/// An object that was rendered alone: where its depth is > 0, which is also its expected depth,
/// metres. It covers nothing outside of the image. Always the full extent.
struct RenderedRegion {
  static constexpr float max_depth = 1e6f;  ///< metres

  ImageView<const float> depth;       ///< of the label image's size
  const TileMask* touched = nullptr;  ///< outside of these tiles depth is 0; null: look at all
};

using Region =
    std::variant<PixelBox, PixelPolygon, PixelMask, RunLengthMask, PixelEllipse, RenderedRegion>;

/// Throws InputError, which says what is wrong, for a region that is none in an image of that size:
/// whatever a target of it would be unknown for.
void check_region(const Region& region, int width, int height);

/// What a region covers of its target.
enum class Extent {
  amodal,  ///< all of it, hidden parts too
  modal    ///< what a detector still sees; compared with the whole target as it was seen before
};

/// From which share of its pixels on a target counts as hidden, and when again as seen. Shares are
/// of the pixels inside the image.
struct TargetThresholds {
  double partial_enter =
      0.05;  ///< hidden share above which `visible` becomes `partial` (the paper)
  double partial_leave = 0.04;          ///< hidden share up to which it becomes `visible` again
  double hidden_enter = 0.90;           ///< hidden share above which it becomes `hidden`
  double hidden_leave = 0.80;           ///< hidden share up to which it becomes `partial` again
  std::optional<double> unknown_limit;  ///< unknown share above which it becomes `unknown`, unless
                                        ///< the verdict is the same were all of it hidden; nothing:
                                        ///< partial_enter
  /// Share of what is measured of it (of its clear and front pixels) from which on it becomes
  /// `unknown` where the sensor looks past its expected depth: it is not there, or transparent.
  /// 1: however much.
  double past_limit = 0.5;
  /// Least share of what is seen of it (clear and front) that must be measured: nothing says that
  /// it is where nothing is measured. Below, a target with an expected depth is `unknown`; of one
  /// without, no estimate is taken. 0: it may be as dark or transparent as it will.
  double min_measured = 0.2;
  double min_inside = 0.0;   ///< at most this share of the extent in the image: out_of_view;
                             ///< of rendered regions, 3-D boxes and meshes 0 alone
  bool beyond_hides = true;  ///< `beyond` counts as occluded; else it counts as clear
  bool others_hide = true;   ///< what is hidden by others than the robot counts in verdicts
  std::size_t point_min_pixels = 5;  ///< trusted depths that a point needs
  double point_min_fraction = 0.2;   ///< and their share of the pixels inside the image

  /// Throws InputError, with the values it got, unless all shares are in 0..1, each leave <= its
  /// enter and each of partial <= that of hidden.
  void check() const;
};

enum class Verdict { visible, partial, hidden, unknown, out_of_view };

/// The verdict's name in report.json.
[[nodiscard]] std::string_view to_string(Verdict verdict);

}  // namespace penumbra
