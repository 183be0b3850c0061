// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/urdf-inl.hpp>

namespace penumbra::detail {

/// The links of a URDF as one tree, in the order that Robot documents.
struct RobotTree {
  std::vector<std::size_t> links;  ///< index into Urdf::links of each link; the root first
  std::vector<Joint> joints;       ///< joints[i].child == i + 1
  std::vector<std::string> variables;
};

/// Throws InputError unless the links form one tree, names are unique and every mimicking joint
/// follows, directly or through others, a joint with a value of its own.
[[nodiscard]] RobotTree build_tree(const Urdf& urdf);

}  // namespace penumbra::detail
