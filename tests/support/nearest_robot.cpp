// SPDX-License-Identifier: Apache-2.0
#include "nearest_robot.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::test {
namespace {

bool is_outline(ImageView<const float> robot, int u, int v) {
  if (!(robot(u, v) > 0.0F)) return false;
  const auto is_clear = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < robot.width && y < robot.height && !(robot(x, y) > 0.0F);
  };
  return is_clear(u - 1, v) || is_clear(u + 1, v) || is_clear(u, v - 1) || is_clear(u, v + 1);
}

/// Offers an outline pixel to all that lie in its reach.
void offer(NearestRobot& nearest, int u, int v, float depth) {
  constexpr int reach = NearestRobot::reach;
  const int width = nearest.squared.width(), height = nearest.squared.height();
  for (int y = std::max(0, v - reach); y <= std::min(height - 1, v + reach); ++y) {
    const int dv = y - v;
    const int across = static_cast<int>(std::sqrt(reach * reach - dv * dv));
    for (int x = std::max(0, u - across); x <= std::min(width - 1, u + across); ++x) {
      const auto squared = static_cast<std::uint16_t>((x - u) * (x - u) + dv * dv);
      if (squared >= nearest.squared(x, y)) continue;
      nearest.squared(x, y) = squared;
      nearest.depth(x, y) = depth;
    }
  }
}

}  // namespace

double NearestRobot::distance(int u, int v) const {
  return squared(u, v) == far ? reach + 1.0 : std::sqrt(squared(u, v));
}

NearestRobot nearest_robot(ImageView<const float> robot) {
  NearestRobot nearest{Image<std::uint16_t>(robot.width, robot.height, NearestRobot::far),
                       Image<float>(robot.width, robot.height)};
  for (int v = 0; v < robot.height; ++v) {
    for (int u = 0; u < robot.width; ++u) {
      if (is_outline(robot, u, v)) offer(nearest, u, v, robot(u, v));
      if (!(robot(u, v) > 0.0F)) continue;
      nearest.squared(u, v) = 0;
      nearest.depth(u, v) = robot(u, v);
    }
  }
  return nearest;
}

}  // namespace penumbra::test
