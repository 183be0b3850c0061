// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/calibration/calibration.hpp>

namespace penumbra {
namespace {

constexpr double nearby = 0.15;         // seconds before and after an image
constexpr double least_nearby = 0.1;    // seconds
constexpr double resting_speed = 0.01;  // metres per second of any link's origin, at most
constexpr double moving_speed = 0.05;   // the same, at least, to tell the time offset
constexpr double fixed_within = 0.002;  // metres and rad that a fixed camera may move on its link

}  // namespace

std::vector<NearbyPoses> nearby_poses(const StampedPoses& trajectory, std::int64_t stamp) {
  std::vector<NearbyPoses> found;
  for (const auto& [time, poses] : trajectory) {
    const double seconds = 1e-9 * static_cast<double>(time - stamp);
    if (std::abs(seconds) <= nearby) found.push_back({seconds, poses});
  }
  std::ranges::sort(found, {}, &NearbyPoses::seconds);
  if (found.empty() || found.front().seconds > -least_nearby || found.back().seconds < least_nearby)
    return {};
  return found;
}

bool CalibrationFrames::Kept::wants(std::span<const Eigen::Isometry3d> T_root_link) const {
  return std::ranges::all_of(frames, [&](const CalibrationFrame& frame) {
    return pose_difference(frame.T_root_link, T_root_link) >= motion;
  });
}

void CalibrationFrames::Kept::add(CalibrationFrame frame) {
  if (!wants(frame.T_root_link)) return;
  frames.push_back(std::move(frame));
  while (frames.size() > most) {
    motion *= 1.5;
    std::vector<CalibrationFrame> all;
    all.swap(frames);
    for (CalibrationFrame& kept : all)
      if (wants(kept.T_root_link)) frames.push_back(std::move(kept));
  }
}

bool CalibrationFrames::is_posed(const RobotPose& pose) const {
  const bool is_partial = std::ranges::any_of(
      pose.uncertain_links, [&](std::size_t link) { return robot_.report()[link].drawn; });
  return pose.status == FrameStatus::ok && !is_partial &&
         (!pose.T_root_link.empty() || pose.positions.size() == robot_.variables().size());
}

std::optional<CalibrationFrame> CalibrationFrames::pass(const Frame& frame) {
  CalibrationFrame kept;
  kept.index = frame.index.value_or(seen_);
  ++seen_;
  const RobotPose& pose = frame.pose;
  const bool is_usable = is_posed(pose);
  if (is_usable) {
    kept.T_root_link = pose.T_root_link;
    if (kept.T_root_link.empty()) {
      kept.joints = pose.positions;
      kept.T_root_link.resize(robot_.links().size());
      robot_.forward_kinematics(kept.joints, kept.T_root_link);
    }
    follow(kept, frame.stamp);
  }
  if (!is_usable || frame.source_status != FrameStatus::ok ||
      (needs_depth_ && is_empty(frame.depth.view))) {
    if (faulty_++ > 0) return {};
    fault_ = "frame " + std::to_string(kept.index) + ": ";
    const std::string& why = !pose.message.empty()            ? pose.message
                             : !pose.uncertain_reason.empty() ? pose.uncertain_reason
                                                              : frame.source_message;
    fault_ += !why.empty() ? why : is_usable ? "has no depth image" : "has no joint positions";
    return {};
  }
  if (pose.T_parent_camera) follow_camera(kept, *pose.T_parent_camera);
  if (moving_ && !(speed_ > moving_speed)) return {};
  const bool is_wanted = all_.wants(kept.T_root_link) || (speed_.value_or(0.0) <= resting_speed &&
                                                          resting_.wants(kept.T_root_link));
  return is_wanted ? std::optional(std::move(kept)) : std::nullopt;
}

void CalibrationFrames::follow(const CalibrationFrame& frame, std::optional<std::int64_t> stamp) {
  if (moving_ && !stamp)
    throw InputError("frame " + std::to_string(frame.index) +
                     " has no stamp: a time offset cannot be estimated");
  speed_.reset();
  if (stamp && stamp_ && *stamp > *stamp_) {
    double most_moved = 0.0;
    for (std::size_t i = 0; i < T_root_link_.size(); ++i)
      most_moved = std::max(
          most_moved, (frame.T_root_link[i].translation() - T_root_link_[i].translation()).norm());
    speed_ = most_moved / (1e-9 * static_cast<double>(*stamp - *stamp_));
  }
  stamp_ = stamp;
  T_root_link_ = frame.T_root_link;
  if (stamp && !has_rested()) trajectory_.emplace_back(*stamp, frame.T_root_link);
}

void CalibrationFrames::follow_camera(const CalibrationFrame& frame,
                                      const Eigen::Isometry3d& T_parent_camera) {
  if (!T_parent_camera_) T_parent_camera_ = T_parent_camera;
  const Eigen::Isometry3d motion = T_parent_camera_->inverse() * T_parent_camera;
  if (motion.translation().norm() > fixed_within ||
      std::abs(Eigen::AngleAxisd(motion.linear()).angle()) > fixed_within)
    throw InputError("frame " + std::to_string(frame.index) +
                     ": tf moves the camera on its link, and only a camera that is fixed to a link "
                     "is calibrated; choose frames with --frames, or its link with --parent and "
                     "--initial");
}

void CalibrationFrames::add(CalibrationFrame frame) {
  if (stamp_) stamps_[frame.index] = *stamp_;
  if (speed_.value_or(0.0) <= resting_speed) resting_.add(frame);
  all_.add(std::move(frame));
}

std::vector<CalibrationFrame> CalibrationFrames::chosen() const {
  if (has_rested()) return resting_.frames;
  std::vector<CalibrationFrame> frames = all_.frames;
  for (CalibrationFrame& frame : frames)
    if (const auto stamp = stamps_.find(frame.index);
        stamp != stamps_.end() && frame.nearby.empty())
      frame.nearby = nearby_poses(trajectory_, stamp->second);
  if (moving_) std::erase_if(frames, [](const auto& frame) { return frame.nearby.empty(); });
  return frames;
}

std::vector<std::string> CalibrationFrames::notes() const {
  std::vector<std::string> lines;
  if (!moving_ && !has_rested() && resting_.frames.size() < all_.frames.size())
    lines.emplace_back(
        "the arm moves in most frames: joint states that are early or late move the result; let it "
        "stand still at some ten poses");
  if (faulty_ > 0)
    lines.push_back(std::to_string(faulty_) + " of " + std::to_string(seen_) +
                    " frames cannot be used; the first is " + fault_);
  return lines;
}

}  // namespace penumbra
