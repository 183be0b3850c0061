// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
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
using OwnedTargets = std::variant<std::vector<OwnedTarget>, SourceTargets>;

/// A frame of Python's: it keeps what C++'s refers to.
struct OwnedFrame {
  std::optional<DepthArgument<"depth">> depth;
  OwnedJoints joints;
  std::optional<std::int64_t> stamp;
  OwnedTargets targets;
  std::optional<Poses> T_root_link;
  std::optional<Eigen::Isometry3d> T_parent_camera;
  FrameStatus source_status = FrameStatus::ok;
  std::string source_message;
  std::optional<std::size_t> index;
  std::optional<std::int64_t> joint_age;  ///< of Numbers, nanoseconds
  std::vector<std::size_t> uncertain_links;
  std::string uncertain_reason;
  std::vector<AttachedBody> attached;

  /// Values that a view refers to in addition to the frame.
  struct Parts {
    std::vector<Target> targets;
    std::vector<double> positions;
  };
  /// Refers to this and to `parts`, which it fills. Raises KeyError for named positions that are
  /// not those of the robot's variables.
  [[nodiscard]] Frame view(const Robot& robot, Parts& parts) const;
};

}  // namespace penumbra::python
