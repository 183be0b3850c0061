// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <sim/experiments/sensed.hpp>

namespace penumbra::sim {

/// Depths in the first camera, metres, of the points that the second camera measures within 2 cm of
/// the ray of a pixel of the first.
[[nodiscard]] std::vector<double> second_depths_on_ray(const Cell& cell, const Sensed& sensed,
                                                       const Eigen::Vector2d& pixel);

}  // namespace penumbra::sim
