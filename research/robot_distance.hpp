// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include <penumbra/robot/robot.hpp>

namespace penumbra::research {

/// Returns the distance of a point in the base frame from the robot's surface, metres; nothing if
/// it is larger than `most`.
[[nodiscard]] std::optional<double> distance_to_robot(const Robot& robot,
                                                      std::span<const double> joints,
                                                      const Eigen::Vector3d& point, double most);

}  // namespace penumbra::research
