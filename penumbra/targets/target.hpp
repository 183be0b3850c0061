// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

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
  std::span<const Eigen::Vector2d> corners;
};

/// The non-zero pixels of an image of the label image's size.
struct PixelMask {
  ImageView<const std::uint8_t> mask;
};

/// COCO's run-length mask, column by column from the left, each from the top: alternating runs of
/// pixels outside and inside, starting outside.
struct RunLengthMask {
  int width = 0, height = 0;  ///< of the label image
  std::span<const std::uint32_t> counts;
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

  ImageView<const float> depth;       ///< of the label image's size
  const TileMask* touched = nullptr;  ///< depth is 0 outside these tiles; null: all are read
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

/// The thresholds of verdicts, as fractions of the pixels inside the image.
struct TargetThresholds {
  double partial_enter =
      0.05;  ///< hidden fraction above which `visible` becomes `partial` (the paper)
  double partial_leave = 0.04;          ///< hidden fraction up to which it becomes `visible` again
  double hidden_enter = 0.90;           ///< hidden fraction above which it becomes `hidden`
  double hidden_leave = 0.80;           ///< hidden fraction up to which it becomes `partial` again
  std::optional<double> unknown_limit;  ///< unknown fraction above which it becomes `unknown`,
                                        ///< unless the verdict would be the same if all of that
                                        ///< were hidden; null: partial_enter
  /// It becomes `unknown` if the sensor measures behind its expected depth in this fraction of its
  /// measured clear and front pixels: it is not there, or transparent. 1 disables the rule.
  double past_limit = 0.5;
  /// The fraction of its clear and front pixels that must be measured. Below it, a target with an
  /// expected depth is `unknown`, and estimates of one without are refused. 0 disables the rule,
  /// for dark or transparent objects.
  double min_measured = 0.2;
  double min_inside = 0.0;           ///< out_of_view if at most this fraction of the extent is in
                                     ///< the image; 0 for rendered regions, 3-D boxes and meshes
  bool beyond_hides = true;          ///< `beyond` counts as occluded; else it counts as clear
  bool others_hide = true;           ///< occlusion by other objects counts in verdicts
  std::size_t point_min_pixels = 5;  ///< trusted depths needed for a point
  double point_min_fraction = 0.2;   ///< and their fraction of the pixels inside the image

  /// Throws InputError with the invalid value unless all fractions are in 0..1, each `leave` is at
  /// most its `enter`, and each `partial` is at most its `hidden`.
  void check() const;
};

enum class Verdict {
  visible,
  partial,
  hidden,
  unknown,
  out_of_view,
  held  ///< a link carries it: an attached body has its name, and no pixels are judged
};

/// In their order.
inline constexpr std::array all_verdicts = {Verdict::visible, Verdict::partial,     Verdict::hidden,
                                            Verdict::unknown, Verdict::out_of_view, Verdict::held};

/// The verdict's name in report.json.
[[nodiscard]] std::string_view to_string(Verdict verdict);

}  // namespace penumbra
