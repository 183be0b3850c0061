// SPDX-License-Identifier: Apache-2.0
// How far in the image a target is from the robot before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/targets/extent_tally.hpp>

namespace penumbra::planning {

/// Pixels; sums of two of their squares are 16-bit numbers.
inline constexpr int max_clearance = 127;

/// A target in the image, kept until it moves there.
struct SeenTarget {
  Eigen::Isometry3d T_camera_frame =
      Eigen::Isometry3d::Identity();  ///< that it was made for: of its reference frame
  double time = std::numeric_limits<double>::quiet_NaN();  ///< of a target that moves; else 0
  std::string fault = {};               ///< why it is unknown; empty: it is known
  std::vector<RowSpan> spans = {};      ///< none: it is not in view
  std::size_t covered = 0, inside = 0;  ///< pixels
  PixelRectangle region = {};           ///< around the spans
  Image<float> depth = {};              ///< metres, of the region; empty: one depth, or unknown
  ExpectedDepth expected = {};          ///< that image or depth
  float before = std::numeric_limits<float>::infinity();  ///< metres: robot nearer is before it
};

/// Measures how far targets are from the robot before them. Serves one thread at a time.
class Clearance {
 public:
  explicit Clearance(const labelling::Rule& rule) : rule_(rule) {}

  /// Returns Prediction::clearance of a target in an image of the robot. `is_hidden`: a pixel of it
  /// is. `most`: pixels, up to max_clearance.
  [[nodiscard]] double measure(const SeenTarget& target, const VirtualDepthView& drawn,
                               bool is_hidden, int most);

 private:
  void mark_blocked(const SeenTarget& target, const VirtualDepthView& drawn,
                    const PixelRectangle& window);
  [[nodiscard]] static std::size_t index(const PixelRectangle& window, int u, int v) {
    return static_cast<std::size_t>(v - window.v0) * static_cast<std::size_t>(window.width()) +
           static_cast<std::size_t>(u - window.u0);
  }
  [[nodiscard]] double free_distance(const SeenTarget& target, const PixelRectangle& window,
                                     int most) const;
  [[nodiscard]] double hidden_depth(const SeenTarget& target, const PixelRectangle& window,
                                    int most);

  labelling::Rule rule_;
  std::vector<std::uint8_t> blocked_;  // of a window: the robot could hide the target there
  std::vector<std::int16_t> columns_;  // of a window: rows to the nearest pixel that is not blocked
  std::vector<std::int16_t> squares_, nearest_;  // of a row: squared distances
};

}  // namespace penumbra::planning
