// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <python/targets.hpp>

#include <penumbra/pipeline/frame.hpp>

namespace penumbra::python {

/// Joint positions, an answer of a JointBuffer, or nothing: not known.
using OwnedJoints = std::variant<std::monostate, JointAnswer, Numbers>;
using OwnedTargets = std::variant<std::vector<OwnedTarget>, SourceTargets>;

/// A frame of Python's: it keeps what C++'s refers to.
struct OwnedFrame {
  std::optional<DepthArgument<"depth">> depth;
  OwnedJoints joints;
  std::optional<std::int64_t> joint_age;  ///< of Numbers, nanoseconds
  std::optional<std::int64_t> stamp;
  Poses T_root_link;
  std::optional<Eigen::Isometry3d> T_parent_camera;
  OwnedTargets targets;
  FrameStatus source_status;
  std::string source_message;
  std::optional<std::size_t> index;
  std::vector<std::size_t> doubted_links;
  std::string doubt;

  /// Refers to this and to `views`, which it fills.
  [[nodiscard]] Frame view(std::vector<Target>& views) const;
};

}  // namespace penumbra::python
