// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/urdf-inl.hpp>

namespace penumbra::detail {

/// The links of a URDF as one tree, in the order that Robot promises.
struct RobotTree {
  std::vector<std::size_t> links;  ///< index into Urdf::links of each link; the root first
  std::vector<Joint> joints;       ///< joints[i].child == i + 1
  std::vector<std::string> variables;
};

/// Throws InputError unless the links form one tree, names are unique and every mimicking joint
/// follows, perhaps over others, a joint that moves by itself.
[[nodiscard]] RobotTree build_tree(const Urdf& urdf);

/// Gives every joint its variable: one of its own, or that of the joint it mimics. `source[i]` is
/// the URDF's joint that became joints[i].
void assign_variables(const Urdf& urdf, const std::vector<std::size_t>& source, RobotTree& tree);

[[noreturn]] void fail_at(const Urdf& urdf, const UrdfJoint& joint, const std::string& what);
[[noreturn]] void fail_at(const Urdf& urdf, const UrdfLink& link, const std::string& what);

}  // namespace penumbra::detail
