// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "real_frames.hpp"

#include <cstddef>
#include <vector>

#include <penumbra/labels/labels.hpp>
#include <penumbra/tuning/carried_points-inl.hpp>

namespace penumbra::test {

/// Returns the pixel of the robot nearest to each pixel. `robot`: virtual depth.
[[nodiscard]] tuning::NearestPixels nearest_robot(ImageView<const float> robot);

/// Points of the arm that are left in a cloud without the robot. tuning::is_carried() says which
/// points count as the arm's.
struct Leftover {
  std::size_t carried = 0;   ///< past the outline, whatever their label
  std::size_t left = 0;      ///< of those, not labelled fringe
  std::size_t on_robot = 0;  ///< measured on the outline's inside
  std::size_t clear = 0;     ///< measured pixels of the whole image that are labelled clear
  [[nodiscard]] double percent() const;  ///< left, of carried and on_robot

  /// Adds a frame. Only rows above `air_rows` count, where nothing real is near the robot.
  /// `measured`: millimetres.
  void add(ImageView<const float> robot, ImageView<const std::uint16_t> measured,
           ImageView<const std::uint8_t> labels, const tuning::NearestPixels& nearest,
           int air_rows);
};

/// Measures a shared recording above its RealFrame::air_rows().
[[nodiscard]] Leftover measure_leftover(const std::vector<RealFrame>& frames,
                                        const std::vector<tuning::NearestPixels>& nearest,
                                        const LabelRule& rule);

/// Counts pixels of objects, and those that are not fringe.
struct Kept {
  std::size_t placements = 0, all = 0, kept = 0;
  void add(const std::vector<int>& pixels, const LabelView& labels);
  [[nodiscard]] double percent() const;
};

[[nodiscard]] double percent(std::size_t part, std::size_t whole);
[[nodiscard]] Label label_at(const LabelView& labels, int pixel);  ///< v * width + u

}  // namespace penumbra::test
