// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <python/targets.hpp>

#include <penumbra/pipeline/frame.hpp>

namespace penumbra::python {

using NamedPositions = std::map<std::string, double>;

/// Joint positions, by name or in order, an answer of a JointBuffer, or nothing: not known.
using OwnedJoints = std::variant<std::monostate, JointAnswer, NamedPositions, Numbers>;

/// A planned motion of a robot.
struct PlannedMotion {
  Robot robot;
  std::shared_ptr<const Trajectory> trajectory;
};

/// A frame of Python's: it keeps what C++'s refers to.
struct OwnedFrame {
  std::optional<DepthArgument<"depth">> depth;
  OwnedJoints joints;
  std::optional<std::int64_t> stamp;
  std::vector<Target> targets;
  std::optional<Poses> T_root_link;
  std::optional<Eigen::Isometry3d> T_parent_camera;
  FrameStatus source_status = FrameStatus::ok;
  std::string source_message;
  std::optional<std::size_t> index;
  std::optional<std::int64_t> joint_age;  ///< of Numbers, nanoseconds
  std::vector<std::size_t> uncertain_links;
  std::string uncertain_reason;
  std::vector<AttachedBody> attached;
  std::optional<PlannedMotion> plan = {};

  /// Refers to this. Raises KeyError for named positions that are not those of the robot's
  /// variables, and ValueError for another number of them.
  [[nodiscard]] Frame view(const Robot& robot) const;
};

}  // namespace penumbra::python
