// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

#include <io/assembly/frame_tree.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// A robot and all that was told of where it is.
struct PosedRobot {
  PosedRobot(Robot what, const PoseHistoryOptions& options)
      : robot(std::move(what)), history(robot, options) {}
  PosedRobot(const PosedRobot&) = delete;
  PosedRobot& operator=(const PosedRobot&) = delete;

  const Robot robot;
  PoseHistory history;
};

struct LiveRobotOptions {
  RobotOptions robot;           ///< for robots that are told
  std::optional<Robot> given;   ///< in place of what is told
  bool compare_sources = true;  ///< of JointBufferOptions and TransformBufferOptions
};

/// A robot that was told and is to be made, which takes as long as its meshes do.
struct RobotOrder {
  std::uint64_t number = 0;  ///< LiveRobot's
  std::string description;
  RobotOptions options;
  bool compare_sources = true;  ///< LiveRobotOptions::compare_sources
};

/// What became of it: a robot, or why it is none.
struct MadeRobot {
  std::uint64_t number = 0;  ///< the order's
  std::shared_ptr<PosedRobot> robot;
  std::string fault;
};

/// Needs nothing else and may run in any thread.
[[nodiscard]] MadeRobot make_robot(const RobotOrder& order);

/// The one robot of a graph, as it is told: by a robot_description, joint states and transforms.
class LiveRobot {
 public:
  explicit LiveRobot(LiveRobotOptions options);

  /// The same text again is nothing new, unless no robot could be made of it: then it is tried
  /// again. Of another one the robot is to be made anew, and what was
  /// told of the old one's joints is forgotten. Until that is done, and of one that cannot be read,
  /// there is no robot: what the old one would say may be wrong. Nothing happens where the robot is
  /// given.
  void take(const StringMessage& description);
  /// The robot that is to be made, each once; null: none is.
  [[nodiscard]] std::unique_ptr<const RobotOrder> take_order() { return std::move(order_); }
  [[nodiscard]] bool has_order() const { return order_ != nullptr; }
  /// Has a robot that could not be made tried again, as its meshes may be there by now.
  void retry();
  /// What was made; nothing happens where another one was told since.
  void place(MadeRobot made);
  /// `source`: who tells it, see MessageSources.
  void take(const JointStateMessage& message, std::string_view source, std::int64_t now);
  void take(const TfMessage& message, bool is_static, std::string_view source, std::int64_t now);

  /// Null: there is none; fault() says why.
  [[nodiscard]] const std::shared_ptr<PosedRobot>& posed() const { return posed_; }
  /// Why the robot that was told is none; empty: it is one, or none was told yet.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Whether one was told and is not made yet.
  [[nodiscard]] bool is_being_made() const { return placed_ != orders_; }

  /// Grows with the frames that TF names.
  [[nodiscard]] std::uint64_t frames_revision() const { return frames_revision_; }
  [[nodiscard]] const FrameTree& frames() const { return frames_; }

  [[nodiscard]] std::size_t robots() const { return robots_; }  ///< that were made
  /// When the last joint state and transform came, on the caller's clock.
  [[nodiscard]] std::optional<std::int64_t> last_joints() const { return last_joints_; }
  [[nodiscard]] std::optional<std::int64_t> last_transforms() const { return last_transforms_; }
  /// When the last joint state came of which a position was taken for this robot.
  [[nodiscard]] std::optional<std::int64_t> last_used_joints() const { return last_used_joints_; }
  /// Of the last one of which none was: why.
  [[nodiscard]] const std::string& unused_joints() const { return unused_joints_; }

 private:
  void replace(std::shared_ptr<PosedRobot> robot);
  void order();

  LiveRobotOptions options_;
  std::shared_ptr<PosedRobot> posed_;
  std::optional<std::string> description_;  // as it was told last
  std::unique_ptr<const RobotOrder> order_;
  std::uint64_t orders_ = 0, placed_ = 0;  // numbers of the last ones
  std::string fault_;
  FrameTree frames_;
  std::uint64_t frames_revision_ = 0;
  std::map<std::string, TransformMessage> static_transforms_;  // by child; told only once
  std::size_t robots_ = 0;
  std::optional<std::int64_t> last_joints_, last_transforms_, last_used_joints_;
  std::string unused_joints_;
};

}  // namespace penumbra::io
