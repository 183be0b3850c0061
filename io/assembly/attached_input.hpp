// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/time/attachments.hpp>

#include <io/ros/moveit_messages.hpp>

namespace penumbra::io {

/// Reads what MoveIt attaches to a robot. A message holds from the stamp of its object on, else of
/// the robot's state in it, else from `now`, the newest stamp known.
class AttachedInput {
 public:
  /// Shapes whose prepared meshes are kept, so that an object attached again costs nothing.
  static constexpr std::size_t max_kept = 32;

  /// Return what cannot be drawn and why, one line; empty: nothing. Such a body is attached without
  /// a mesh, which makes its frames `missing_link`. `robot`: of several robots, the name that
  /// begins those of its links and objects.
  std::string take(const AttachedObjectMessage& message, std::int64_t now, Attachments& to,
                   const std::string& robot = {});
  std::string take(const PlanningSceneMessage& message, std::int64_t now, Attachments& to,
                   const std::string& robot = {});

 private:
  [[nodiscard]] std::shared_ptr<const PreparedMesh> prepared(TriangleMesh mesh);

  std::vector<std::pair<TriangleMesh, std::shared_ptr<const PreparedMesh>>> kept_;
};

}  // namespace penumbra::io
