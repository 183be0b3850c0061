// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <penumbra/pipeline/pose_history.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/ros/messages.hpp>
#include <io/ros_frames/frame_tree.hpp>

namespace penumbra::io {

/// A robot and all that was told of where it is.
struct PosedRobot {
  explicit PosedRobot(Robot what) : robot(std::move(what)), history(robot) {}
  PosedRobot(const PosedRobot&) = delete;
  PosedRobot& operator=(const PosedRobot&) = delete;

  const Robot robot;
  PoseHistory history;
};

struct LiveRobotOptions {
  RobotOptions robot;          ///< for robots that are told
  std::optional<Robot> given;  ///< in place of what is told
};

/// The one robot of a graph, as it is told: by a robot_description, joint states and transforms.
class LiveRobot {
 public:
  explicit LiveRobot(LiveRobotOptions options);

  /// The same text again is nothing new. Of another one the robot is made anew, and what was told
  /// of the old one's joints is forgotten. Of one that cannot be read there is no robot: what the
  /// old one would say may be wrong. Nothing happens where the robot is given.
  void take(const StringMessage& description);
  void take(const JointStateMessage& message, std::int64_t now);
  void take(const TfMessage& message, bool is_static, std::int64_t now);

  /// Null: there is none; fault() says why.
  [[nodiscard]] const std::shared_ptr<PosedRobot>& posed() const { return posed_; }
  /// Why the robot that was told is none; empty: it is one, or none was told yet.
  [[nodiscard]] const std::string& fault() const { return fault_; }

  /// Grows with the frames that TF names.
  [[nodiscard]] std::uint64_t frames_revision() const { return frames_revision_; }
  [[nodiscard]] const FrameTree& frames() const { return frames_; }

  [[nodiscard]] std::size_t robots() const { return robots_; }  ///< that were made
  /// When the last joint state and transform came, on the caller's clock.
  [[nodiscard]] std::optional<std::int64_t> last_joints() const { return last_joints_; }
  [[nodiscard]] std::optional<std::int64_t> last_transforms() const { return last_transforms_; }

 private:
  void replace(Robot robot);

  LiveRobotOptions options_;
  std::shared_ptr<PosedRobot> posed_;
  std::optional<std::string> description_;  // as it was told last
  std::string fault_;
  FrameTree frames_;
  std::uint64_t frames_revision_ = 0;
  std::map<std::string, TransformMessage> static_transforms_;  // by child; told only once
  std::size_t robots_ = 0;
  std::optional<std::int64_t> last_joints_, last_transforms_;
};

}  // namespace penumbra::io
