// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/calibration/kept_frames.hpp>

namespace penumbra {
namespace {

constexpr std::size_t near_frames = 7;   // whose poses are kept with a frame
constexpr double near_seconds = 0.25;    // likewise
constexpr double least_nearby = 0.0999;  // seconds: rounded stamps of 0.1
constexpr double resting_speed = 0.01;   // metres per second of any link's origin, at most
constexpr double moving_speed = 0.05;    // the same, at least, to tell the time offset
constexpr double fixed_within = 0.002;   // metres and rad that a fixed camera may move on its link

/// Intrinsics of the middles of blocks of pixels.
Intrinsics thinned(const Intrinsics& camera, int block) {
  const int middle = block / 2;
  return {camera.width() / block, camera.height() / block,        camera.fx() / block,
          camera.fy() / block,    (camera.cx() - middle) / block, (camera.cy() - middle) / block};
}

/// Whether the pose of one is kept with the other.
bool is_near(const KeptFrame& earlier, const KeptFrame& later) {
  return later.number <= earlier.number + near_frames ||
         later.seconds_after(earlier).value_or(near_seconds) < near_seconds;
}

}  // namespace

std::optional<double> KeptFrame::seconds_after(const KeptFrame& other) const {
  if (!stamp || !other.stamp) return std::nullopt;
  return 1e-9 * static_cast<double>(*stamp - *other.stamp);
}

bool KeptFrame::tells_time() const {
  const auto reaches = [&](double sign) {
    return std::ranges::any_of(nearby, [&](const KeptFrame& near) {
      const double seconds = sign * near.seconds_after(*this).value_or(0.0);
      return seconds >= least_nearby && seconds <= near_seconds;
    });
  };
  return reaches(-1.0) && reaches(1.0);
}

std::vector<Eigen::Isometry3d> poses_at(const Robot& robot, const KeptFrame& frame,
                                        double seconds) {
  constexpr double farthest = 1.5, farthest_linear = 0.15;  // seconds between two poses
  const auto time = [&](const auto& near) { return near->seconds_after(frame).value_or(0.0); };
  const std::vector<KeptFrame>& around = frame.nearby;
  auto after = around.begin();
  while (after != around.end() && time(after) < seconds) ++after;
  if (!frame.stamp || after == around.begin() || after == around.end()) return {};
  const auto before = std::prev(after);
  const bool by_joints = !before->joints.empty() && !after->joints.empty();
  const double gap = time(after) - time(before), x = (seconds - time(before)) / gap;
  if (gap > (by_joints ? farthest : farthest_linear)) return {};
  std::vector<Eigen::Isometry3d> poses = before->T_root_link;
  if (!by_joints) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Isometry3d& next = after->T_root_link[i];
      poses[i].translation() += x * (next.translation() - poses[i].translation());
      poses[i].linear() = Eigen::Quaterniond(poses[i].linear())
                              .slerp(x, Eigen::Quaterniond(next.linear()))
                              .toRotationMatrix();
    }
    return poses;
  }
  // Cubic (Catmull and Rom 1974), with the slopes of the neighbours.
  const auto first = before == around.begin() ? before : std::prev(before);
  const auto last = std::next(after) == around.end() ? after : std::next(after);
  std::vector<double> joints(before->joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double a = before->joints[j], b = after->joints[j];
    const double slope_a = gap * (b - first->joints[j]) / (time(after) - time(first));
    const double slope_b = gap * (last->joints[j] - a) / (time(last) - time(before));
    joints[j] = a + x * (slope_a + x * (3 * (b - a) - 2 * slope_a - slope_b +
                                        x * (2 * (a - b) + slope_a + slope_b)));
  }
  robot.forward_kinematics(joints, poses);
  return poses;
}

void check_enough(std::span<const KeptFrame> frames, const std::string& purpose) {
  if (frames.size() >= KeptFrames::least) return;
  throw InputError(purpose + " needs " + std::to_string(KeptFrames::least) +
                   " frames or more with different poses of the robot, and has " +
                   std::to_string(frames.size()) +
                   ": record the arm in some ten poses, with links near and far, left and right");
}

KeptFrames::KeptFrames(const Robot& robot, const Camera& camera, const Options& options)
    : robot_(robot),
      options_(options),
      raw_(camera.intrinsics),
      block_(1),
      camera_(camera.intrinsics),
      motion_(options.motion) {
  if (!camera.distortion.is_none()) camera_ = lens_.emplace(camera).pinhole();
  if (options.columns > 0)
    block_ = std::clamp(camera_.width() / options.columns, 1, camera_.height());
  camera_ = thinned(camera_, block_);
}

bool KeptFrames::has_rested() const {
  return options_.choice == Choice::rest_first &&
         std::ranges::count_if(frames_, &KeptFrame::is_resting) >=
             static_cast<std::ptrdiff_t>(least);
}

/// Frames at rest are compared with others at rest only: they take the place of moving ones.
bool KeptFrames::wants(const KeptFrame& frame) const {
  const bool is_better = options_.choice == Choice::rest_first && frame.is_resting;
  return (frame.is_resting || !has_rested()) &&
         std::ranges::all_of(frames_, [&](const KeptFrame& kept) {
           return (is_better && !kept.is_resting) ||
                  pose_difference(kept.T_root_link, frame.T_root_link) >= motion_;
         });
}

void KeptFrames::add(KeptFrame frame) {
  frame.nearby.assign(recent_.begin(), recent_.end());
  const bool has_moved_only = !has_rested();
  if (options_.choice == Choice::rest_first && frame.is_resting)
    std::erase_if(frames_, [&](const KeptFrame& kept) {
      return !kept.is_resting && pose_difference(kept.T_root_link, frame.T_root_link) < motion_;
    });
  frames_.push_back(std::move(frame));
  if (has_moved_only && has_rested()) {
    std::erase_if(frames_, [](const KeptFrame& kept) { return !kept.is_resting; });
    motion_ = options_.motion;
  }
  while (frames_.size() > options_.most) {
    motion_ *= 1.5;
    std::vector<KeptFrame> all;
    all.swap(frames_);
    for (KeptFrame& kept : all)
      if (wants(kept)) frames_.push_back(std::move(kept));
  }
}

void KeptFrames::check_size(int width, int height) const {
  if (is_size(width, height)) return;
  throw InputError("an image is " + std::to_string(width) + "x" + std::to_string(height) +
                   ", the camera's are " + std::to_string(raw_.width()) + "x" +
                   std::to_string(raw_.height()));
}

/// Without poses if they are not all known.
KeptFrame KeptFrames::posed_frame(const Frame& frame) const {
  const RobotPose& pose = frame.pose;
  KeptFrame posed{.index = frame.index.value_or(seen_), .stamp = frame.stamp};
  const bool is_partial = std::ranges::any_of(
      pose.uncertain_links, [&](std::size_t link) { return robot_.report()[link].drawn; });
  // Where only the camera's pose is unknown, the robot's is there.
  const bool may_lack_camera =
      pose.status == FrameStatus::missing_transform || pose.status == FrameStatus::stale_transform;
  if ((pose.status != FrameStatus::ok && !may_lack_camera) || is_partial) return posed;
  posed.T_root_link = pose.T_root_link;
  if (!posed.T_root_link.empty() || pose.positions.size() != robot_.variables().size())
    return posed;
  posed.joints = pose.positions;
  posed.T_root_link.resize(robot_.links().size());
  robot_.forward_kinematics(posed.joints, posed.T_root_link);
  return posed;
}

void KeptFrames::refuse(std::size_t index, const std::string& why) {
  last_fault_ = why;
  if (faulty_++ == 0) fault_ = "frame " + std::to_string(index) + ": " + why;
}

/// Takes poses between images that are farther apart than those kept with a frame: they tell
/// whether the robot rests, and whether the poses are of another time.
void KeptFrames::follow_until(const Frame& frame) {
  constexpr std::int64_t step = 50'000'000, reach = 250'000'000;  // ns; near_seconds
  if (!frame.pose_at || !frame.stamp) return;
  const std::optional<std::int64_t> last = recent_.empty() ? std::nullopt : recent_.back().stamp;
  if (last && *frame.stamp - *last <= reach) return;
  Frame between;
  const auto follow_at = [&](std::int64_t stamp) {
    between.stamp = stamp;
    frame.pose_at(stamp, between.pose);
    follow(between);
  };
  for (std::int64_t by = step; last && by <= reach; by += step) follow_at(*last + by);
  for (std::int64_t by = reach; by > 0; by -= step)
    if (!last || *frame.stamp - by > *last + reach) follow_at(*frame.stamp - by);
}

void KeptFrames::follow(const Frame& frame) {
  follow_until(frame);
  if (KeptFrame posed = posed_frame(frame); !posed.T_root_link.empty()) (void)follow(posed);
}

std::optional<KeptFrame> KeptFrames::pass(const Frame& frame) {
  follow_until(frame);
  const RobotPose& pose = frame.pose;
  KeptFrame passed = posed_frame(frame);
  const bool has_pose = !passed.T_root_link.empty();
  const bool has_image = frame.source_status == FrameStatus::ok &&
                         (!options_.needs_depth || !is_empty(frame.depth.view));
  ++seen_;
  if (has_image) ++images_;
  const bool is_wanted = has_pose && follow(passed);
  if (has_pose && has_image) {
    if (pose.T_parent_camera) follow_camera(passed, *pose.T_parent_camera);
    return is_wanted ? std::optional(std::move(passed)) : std::nullopt;
  }
  const std::string& why = !pose.message.empty()            ? pose.message
                           : !pose.uncertain_reason.empty() ? pose.uncertain_reason
                                                            : frame.source_message;
  refuse(passed.index, !why.empty() ? why
                       : has_pose   ? "has no depth image"
                                    : "has no joint positions");
  return {};
}

bool KeptFrames::is_usable(const FrameReport& report) const {
  const auto is_finite = [](const Eigen::Isometry3d& T) { return T.matrix().allFinite(); };
  return has_depth(report.status) && report.T_root_camera &&
         (!options_.needs_depth || !is_empty(report.depth)) &&
         std::ranges::all_of(report.T_root_link, is_finite);
}

std::optional<KeptFrame> KeptFrames::pass(const FrameReport& report,
                                          std::span<const double> joints) {
  ++seen_;
  if (!is_usable(report)) {
    refuse(report.index, report.message);
    return {};
  }
  ++images_;
  KeptFrame passed{.index = report.index,
                   .stamp = report.stamp,
                   .T_root_link = {report.T_root_link.begin(), report.T_root_link.end()},
                   .T_root_camera = report.T_root_camera};
  if (joints.size() == robot_.variables().size())
    passed.joints.assign(joints.begin(), joints.end());
  const bool is_wanted = follow(passed);
  follow_camera(passed, passed.T_root_link[options_.parent].inverse() * *report.T_root_camera);
  return is_wanted ? std::optional(std::move(passed)) : std::nullopt;
}

/// Adds a pose to the recent ones and to those around the kept frames. Returns whether the frame is
/// wanted.
bool KeptFrames::follow(KeptFrame& frame) {
  const bool moving_only = options_.choice == Choice::moving;
  if (moving_only && !frame.stamp)
    throw InputError("frame " + std::to_string(frame.index) +
                     " has no stamp: a time offset cannot be estimated");
  frame.number = images_;
  const bool is_first = recent_.empty();
  const std::optional<double> seconds =
      is_first ? std::nullopt : frame.seconds_after(recent_.back());
  if (!is_first && frame.joints.empty() != recent_.back().joints.empty()) return false;
  if (seconds && *seconds < 0.0) recent_.clear();
  if (!seconds || *seconds != 0.0) {
    speed_ = 0.0;
    for (std::size_t i = 0; seconds && *seconds > 0.0 && i < frame.T_root_link.size(); ++i)
      speed_ = std::max(
          speed_, (frame.T_root_link[i].translation() - recent_.back().T_root_link[i].translation())
                          .norm() /
                      *seconds);
    recent_.push_back(frame);
    while (!is_near(recent_.front(), frame)) recent_.pop_front();
    for (KeptFrame& kept : frames_)
      if (is_near(kept, frame) && frame.number >= kept.number) kept.nearby.push_back(frame);
  }
  frame.is_resting = speed_ <= resting_speed;
  return (!moving_only || speed_ > moving_speed) && wants(frame);
}

void KeptFrames::follow_camera(const KeptFrame& frame, const Eigen::Isometry3d& T_parent_camera) {
  if (!T_parent_camera_) T_parent_camera_ = T_parent_camera;
  const Eigen::Isometry3d motion = T_parent_camera_->inverse() * T_parent_camera;
  if (options_.camera_stays &&
      (motion.translation().norm() > fixed_within ||
       std::abs(Eigen::AngleAxisd(motion.linear()).angle()) > fixed_within))
    throw InputError("frame " + std::to_string(frame.index) + ": the camera moves relative to " +
                     robot_.links()[options_.parent] +
                     "; choose frames in which it does not (--frames), or the link that carries "
                     "it (--parent, of calibrate with --initial)");
}

std::vector<KeptFrame> KeptFrames::chosen() const {
  std::vector<KeptFrame> chosen = frames_;
  if (options_.choice == Choice::moving)
    std::erase_if(chosen, [](const KeptFrame& frame) { return !frame.tells_time(); });
  return chosen;
}

std::vector<std::string> KeptFrames::notes() const {
  std::vector<std::string> lines;
  if (options_.choice == Choice::rest_first &&
      !std::ranges::all_of(frames_, &KeptFrame::is_resting))
    lines.emplace_back(
        "the arm moves in most frames: joint states that are early or late move the result; let it "
        "stand still at some ten poses");
  if (faulty_ > 0)
    lines.push_back(std::to_string(faulty_) + " of " + std::to_string(seen_) +
                    " frames cannot be used; the first is " + fault_);
  return lines;
}

}  // namespace penumbra
