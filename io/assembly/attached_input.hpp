// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/time/pose_history.hpp>

#include <io/ros/moveit_messages.hpp>

namespace penumbra::io {

struct PosedRobot;

/// Reads what MoveIt attaches to a robot. A message holds from the stamp of its object on, else of
/// the robot's state in it, else from `now`, the last stamp received. The stamp of an earlier
/// message of the object, and that of a removal from before the object was attached, count as
/// `now`. An object that was removed after the stamp is attached again from `now` on.
///
/// A message may name an object without its shape. Then the object keeps the shape with which it is
/// attached, else it has that of the world's object of that name, else that of the next message.
class AttachedInput {
 public:
  /// Shapes whose prepared meshes are kept, so that an object attached again costs nothing.
  static constexpr std::size_t max_kept = 32;
  /// Objects of the world that are kept; further ones have no shape when they are attached.
  static constexpr std::size_t max_world = 1000;

  /// Return what cannot be drawn and why, one line; empty: nothing. Such a body is attached without
  /// triangles, which makes its frames `missing_link`. `robot`: of several robots, the name that
  /// begins those of its links and objects. `posed`: for objects whose pose is in another link; may
  /// be null.
  std::string take(const AttachedObjectMessage& message, std::int64_t now, Attachments& to,
                   const std::string& robot = {}, const PosedRobot* posed = nullptr);
  std::string take(const PlanningSceneMessage& message, std::int64_t now, Attachments& to,
                   const std::string& robot = {}, const PosedRobot* posed = nullptr);

 private:
  std::string change(const AttachedObjectMessage& message, std::int64_t now, Attachments& to,
                     const std::string& robot, const PosedRobot* posed);
  [[nodiscard]] std::shared_ptr<const PreparedMesh> prepared(TriangleMesh mesh);
  void follow_world(const CollisionObjectMessage& object, const std::string& prefix);

  std::vector<std::pair<TriangleMesh, std::shared_ptr<const PreparedMesh>>> kept_;
  std::map<std::string, CollisionObjectMessage> world_;  // by name
};

}  // namespace penumbra::io
