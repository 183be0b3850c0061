// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nearest_robot.hpp"
#include "object_beside.hpp"
#include "real_frames.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <penumbra/labels/labels.hpp>

namespace penumbra::test {

/// A measured point counts as the robot's that the sensor carried past the silhouette if it lies
/// this near to it in the image and in depth. Only in SidePaster::air_rows, where nothing real is
/// so near.
inline constexpr double leftover_pixels = 40.0;
inline constexpr double leftover_depth = 0.10;  // metres

/// Calls f(u, v, distance) for each such pixel; distance in pixels from the silhouette.
template <typename F>
void for_each_carried(const RealFrame& frame, const NearestRobot& nearest, F&& f) {
  for (int v = 0; v < SidePaster::air_rows; ++v)
    for (int u = 0; u < frame.measured.width(); ++u) {
      if (frame.measured(u, v) == 0 || frame.robot(u, v) > 0.0F) continue;
      const double distance = nearest.distance(u, v);
      const double behind = 0.001 * static_cast<double>(frame.measured(u, v)) -
                            static_cast<double>(nearest.depth(u, v));
      if (distance <= leftover_pixels && std::abs(behind) <= leftover_depth) f(u, v, distance);
    }
}

/// Points of the arm that are left in a cloud without the robot.
struct Leftover {
  std::size_t carried = 0;   ///< past the silhouette, whatever their label
  std::size_t left = 0;      ///< of those, not labelled fringe
  std::size_t on_robot = 0;  ///< measured on the silhouette, in the air rows
  std::size_t clear = 0;     ///< measured pixels of the whole image that are labelled clear
  std::size_t front = 0;     ///< pixels labelled front
  std::size_t mask = 0;      ///< of robot_mask_N.png
  [[nodiscard]] double percent() const;        ///< left, of carried and on_robot
  [[nodiscard]] double front_percent() const;  ///< of the mask
};

[[nodiscard]] Leftover measure_leftover(const std::vector<RealFrame>& frames,
                                        const std::vector<NearestRobot>& nearest,
                                        const LabelRule& rule);

/// How many of an object's measured pixels are not fringe.
struct Kept {
  std::size_t placements = 0, core = 0, core_kept = 0, band = 0, band_kept = 0;
  void add(const MeasuredPaste::Pixels& pixels, const LabelView& labels);
  void add(const Kept& other);
  [[nodiscard]] double core_percent() const;
  [[nodiscard]] double band_percent() const;  ///< of 2 pixels at its edge
};

[[nodiscard]] double percent(std::size_t part, std::size_t whole);
[[nodiscard]] Label label_at(const LabelView& labels, int pixel);  ///< v * width + u

}  // namespace penumbra::test
