// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <variant>

#include <python/arrays.hpp>
#include <python/fields.hpp>
#include <python/targets.hpp>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/time/joint_buffer.hpp>

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

/// Calls a Python function, also where others hold the GIL.
struct PoseFunction {
  std::shared_ptr<const void> owner;  ///< of owner_of()
  [[nodiscard]] const py::object& function() const {
    return *static_cast<const py::object*>(owner.get());
  }
  void operator()(std::int64_t stamp, RobotPose& pose) const;
};

/// Raises ValueError for positions that are not one for each of the robot's variables.
void check_positions(const RobotPose& pose, const Robot& robot);

/// What pose_of() takes: an answer, names with positions, or a pose.
using NamedPositions = std::map<std::string, double>;
using Joints = std::variant<JointAnswer, NamedPositions, PoseArgument>;

/// Returns the pose. Raises KeyError or ValueError for positions that are missing, too many or not
/// finite.
[[nodiscard]] RobotPose known_pose(const Robot& robot, const Joints& joints);

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
struct type_caster<penumbra::PoseAt> : penumbra::python::ValueCaster<penumbra::PoseAt> {
  using Function = penumbra::python::PoseFunction;
  static constexpr auto name = const_name("Optional[Callable[[int], ") +
                               make_caster<penumbra::python::PoseArgument>::name + const_name("]]");
  bool load(handle source, bool /*convert*/) {
    if (source.is_none()) return true;
    if (PyCallable_Check(source.ptr()) == 0) return false;
    value = Function{penumbra::python::owner_of(reinterpret_borrow<object>(source))};
    return true;
  }
  static handle cast(const penumbra::PoseAt& of, return_value_policy /*policy*/,
                     handle /*parent*/) {
    const auto* const known = of.target<Function>();
    return known != nullptr ? known->function().inc_ref() : none().inc_ref();
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
