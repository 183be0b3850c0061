// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene.hpp"

#include <cstdint>
#include <vector>

namespace example {

/// What the camera's pixels see, exactly.
struct Truth {
  std::vector<double> depth;        ///< metres along the optical axis; infinite: nothing
  std::vector<double> facing;       ///< cosine between the surface's normal and the ray
  std::vector<std::uint8_t> shade;  ///< 1: the second imager does not see this point
  std::vector<std::uint8_t> mask;   ///< MaskValue
};

enum MaskValue : std::uint8_t {
  no_robot = 0,      ///< no robot on this ray
  robot_seen = 1,    ///< the robot is the nearest thing, no object behind it
  before_robot = 2,  ///< something stands before the robot
  hidden = 3,        ///< the robot is the nearest thing and an object is behind it
};

[[nodiscard]] Truth cast_truth(const Scene& scene, const View& view);

/// The truth as a stereo camera measures it, millimetres, 0 = no measurement: disparities with
/// patchy noise in steps of a sixteenth of a pixel, borders that wander, mixed pixels and holes at
/// depth edges, no measurement where the second imager does not see, on grazing faces, in random
/// blobs and beyond 4 m.
[[nodiscard]] std::vector<std::uint16_t> measure(const Truth& truth, std::uint64_t seed);

/// The colour image, 8-bit RGB.
[[nodiscard]] std::vector<std::uint8_t> shade_colours(const Scene& scene, const View& view);

}  // namespace example
