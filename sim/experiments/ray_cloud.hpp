// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <sim/experiments/sensed.hpp>

namespace penumbra::sim {

/// Depths in the first camera, metres, of all points that either depth camera measures within 2 cm
/// of a pixel's ray.
[[nodiscard]] std::vector<double> depths_on_ray(const Cell& cell, const Sensed& sensed,
                                                const Eigen::Vector2d& pixel);

}  // namespace penumbra::sim
