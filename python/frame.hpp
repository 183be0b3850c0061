// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <python/arrays.hpp>
#include <python/fields.hpp>
#include <python/targets.hpp>

#include <penumbra/pipeline/frame.hpp>

namespace penumbra::python {

/// A pose as an argument: a RobotPose, positions in the order of Robot.variables, or None: unknown.
struct PoseArgument {
  RobotPose pose;
  operator RobotPose() && { return std::move(pose); }  // NOLINT(google-explicit-constructor)
};
template <>
struct GivenAs<RobotPose> {
  using type = PoseArgument;
};

/// Raises ValueError for positions that are not one for each of the robot's variables.
void check_positions(const RobotPose& pose, const Robot& robot);

}  // namespace penumbra::python

namespace pybind11::detail {

template <>
struct type_caster<penumbra::python::PoseArgument>
    : penumbra::python::ValueCaster<penumbra::python::PoseArgument> {
  static constexpr auto name = const_name("Union[penumbra.RobotPose, ") +
                               make_caster<penumbra::python::Numbers>::name + const_name(", None]");
  bool load(handle source, bool /*convert*/) {
    if (source.is_none()) return true;
    if (hasattr(source, "keys")) return false;  // names need the robot: pose_of()
    if (isinstance<penumbra::RobotPose>(source))
      value.pose = source.cast<const penumbra::RobotPose&>();
    else
      value.pose.positions = penumbra::python::vector_of(source);
    return true;
  }
};
template <>
struct type_caster<std::shared_ptr<const penumbra::Trajectory>>
    : penumbra::python::ValueCaster<std::shared_ptr<const penumbra::Trajectory>> {
  using Held = make_caster<std::shared_ptr<penumbra::Trajectory>>;
  static constexpr auto name = const_name("Optional[") + Held::name + const_name("]");
  bool load(handle source, bool convert) {
    Held held;
    if (!source.is_none() && !held.load(source, convert)) return false;
    if (!source.is_none()) value = cast_op<std::shared_ptr<penumbra::Trajectory>&>(held);
    return true;
  }
  static handle cast(const std::shared_ptr<const penumbra::Trajectory>& of,
                     return_value_policy policy, handle parent) {
    return Held::cast(std::const_pointer_cast<penumbra::Trajectory>(of), policy, parent);
  }
};

}  // namespace pybind11::detail
