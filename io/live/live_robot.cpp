// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/live/live_robot.hpp>
#include <io/ros_frames/pose_messages.hpp>

namespace penumbra::io {

LiveRobot::LiveRobot(LiveRobotOptions options) : options_(std::move(options)) {
  if (options_.given) replace(*options_.given);
}

void LiveRobot::replace(Robot robot) {
  posed_ = std::make_shared<PosedRobot>(std::move(robot));
  for (const auto& [child, t] : static_transforms_)
    posed_->history.add_static_transform(t.header.frame_id, t.child_frame_id, t.T_parent_child);
  ++robots_;
}

void LiveRobot::take(const StringMessage& description) {
  if (options_.given || description_ == description.data) return;
  description_ = description.data;
  posed_.reset();
  fault_.clear();
  try {
    // Meshes of relative paths would be looked for where the program happens to have been started.
    replace(Robot::parse(description.data, "/", options_.robot));
  } catch (const InputError& error) {
    fault_ = error.what();
  }
}

void LiveRobot::take(const JointStateMessage& message, std::int64_t now) {
  last_joints_ = now;
  if (posed_) add_to_history(message, posed_->history);
}

void LiveRobot::take(const TfMessage& message, bool is_static, std::int64_t now) {
  last_transforms_ = now;
  for (const TransformMessage& t : message.transforms) {
    if (frames_.add(t.header.frame_id, t.child_frame_id)) ++frames_revision_;
    if (is_static && (static_transforms_.contains(t.child_frame_id) ||
                      static_transforms_.size() < FrameTree::max_frames))
      static_transforms_[t.child_frame_id] = t;
  }
  if (posed_) add_to_history(message, is_static, posed_->history);
}

}  // namespace penumbra::io
