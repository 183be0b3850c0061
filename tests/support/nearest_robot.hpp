// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

/// For each pixel, the nearest pixel of the robot's silhouette.
struct NearestRobot {
  static constexpr int reach = 64;  ///< pixels that are looked at; farther ones: `far` and depth 0
  static constexpr std::uint16_t far = 0xFFFF;

  Image<std::uint16_t> squared;  ///< distance^2, pixels; 0 on the robot
  Image<float> depth;            ///< its virtual depth, metres

  [[nodiscard]] double distance(int u, int v) const;  ///< pixels; `reach` + 1 where it is farther
};

/// `robot`: virtual depth, 0 where no robot is.
[[nodiscard]] NearestRobot nearest_robot(ImageView<const float> robot);

}  // namespace penumbra::test
