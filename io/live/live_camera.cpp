// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>

#include <io/live/live_camera.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_kept_colors = 8;
constexpr std::size_t most_intervals = 4;

}  // namespace

std::string_view to_string(LiveDrop reason) {
  switch (reason) {
    case LiveDrop::unreadable:
      return "unreadable";
    case LiveDrop::not_ready:
      return "not_ready";
    case LiveDrop::changed:
      return "changed";
    case LiveDrop::no_camera_info:
      return "no_camera_info";
    default:
      return to_string(static_cast<DropReason>(reason));
  }
}

LiveCamera::LiveCamera(LiveCameraOptions options, const LiveRobot& robot)
    : options_(std::move(options)), robot_(robot), colors_(most_kept_colors) {}

void LiveCamera::drop_unreadable() {
  ++counts_.received;
  drop(LiveDrop::unreadable);
}

void LiveCamera::take_depth(KeptImage image, std::int64_t now) {
  ++counts_.received;
  if (last_depth_) intervals_.push_back(now - *last_depth_);
  if (intervals_.size() > most_intervals) intervals_.pop_front();
  last_depth_ = now;
  last_stamp_ = image.header().stamp;
  depth_frame_ = image.header().frame_id;
  pairs_.add_image(last_stamp_);
  refresh();
  if (!setup_) return drop(LiveDrop::not_ready);
  if (last_stamp_ < valid_from_) return drop(LiveDrop::changed);
  arrived_.push_back({std::move(image), now});
  if (arrived_.size() > options_.max_frames) {
    arrived_.pop_front();
    drop(LiveDrop::overflow);
  }
  admit(now);
}

void LiveCamera::take_info(const CameraInfoMessage& info, std::int64_t now) {
  const std::int64_t stamp = info.header.stamp;
  const bool jumped = is_clock_jump(stamp, newest_info_);
  newest_info_ = jumped ? stamp : std::max(newest_info_, stamp);
  pairs_.add_info(stamp);
  if (jumped) valid_from_ = 0;
  if (!info_ || !is_same_camera(*info_, info)) {
    if (info_) {
      ++camera_changes_;
      valid_from_ = stamp;
    }
    info_ = info;
    ++cameras_revision_;
  }
  refresh();
  admit(now);
}

void LiveCamera::take_color_info(const CameraInfoMessage& info) {
  if (color_info_ && is_same_camera(*color_info_, info)) return;
  if (color_info_) {
    ++camera_changes_;
    valid_from_ = std::max(valid_from_, info.header.stamp);
  }
  color_info_ = info;
  ++cameras_revision_;
  refresh();
}

void LiveCamera::refresh() {
  Basis basis{.robot = robot_.posed().get(),
              .frames = robot_.frames_revision(),
              .cameras = cameras_revision_,
              .depth_frame = depth_frame_};
  if (basis == basis_) return;
  const bool only_frames_are_new = setup_ && basis.robot == basis_.robot &&
                                   basis.cameras == basis_.cameras &&
                                   basis.depth_frame == basis_.depth_frame;
  basis_ = std::move(basis);
  setup_fault_.clear();
  std::shared_ptr<LiveSetup> made = make_setup();
  if (only_frames_are_new && made && made->mount == setup_->mount) return;
  drop_waiting(LiveDrop::changed);
  if (setup_) {
    targets_.replaced += setup_->targets.replaced();
    targets_.discarded += setup_->targets.discarded() + setup_->targets.waiting();
  }
  setup_ = std::move(made);
}

std::shared_ptr<LiveSetup> LiveCamera::make_setup() {
  if (!robot_.posed() || !info_ || depth_frame_.empty() || lacks_color_info()) return nullptr;
  const Robot& robot = robot_.posed()->robot;
  try {
    JudgedCameras cameras = find_cameras();
    const std::string& frame = cameras.judged.frame_id;
    CameraMount mount = find_mount(robot, options_.mount, robot_.frames(), frame)
                            .value_or(mount_by_root(robot, options_.mount, frame));
    const FrameQueueOptions queue{.policy = DropPolicy::newest,
                                  .time_offset = options_.time_offset,
                                  .max_wait = options_.max_wait,
                                  .max_frames = options_.max_frames,
                                  .poses = {.source = options_.poses,
                                            .frame_prefix = options_.mount.frame_prefix,
                                            .camera_parent = mount.parent,
                                            .camera_frame = mount.frame}};
    const auto on_drop = [this](const DroppedFrame& frame_) {
      queued_.erase(frame_.key);
      drop(static_cast<LiveDrop>(frame_.reason));
    };
    return std::make_shared<LiveSetup>(robot_.posed(), std::move(cameras), std::move(mount), queue,
                                       on_drop);
  } catch (const InputError& error) {
    setup_fault_ = error.what();
    return nullptr;
  }
}

JudgedCameras LiveCamera::find_cameras() const {
  CameraEvidence evidence{.source = {},
                          .depth = {*info_, options_.info_topic, options_.depth_topic},
                          .color = {},
                          .depth_frame = depth_frame_,
                          .info_is_named = options_.info_is_named,
                          .is_rectified = options_.is_rectified};
  if (color_info_ && !options_.color_info_topic.empty())
    evidence.color.emplace(
        InfoOfImages{*color_info_, options_.color_info_topic, options_.color_topic});
  return judged_cameras(evidence);
}

void LiveCamera::drop_waiting(LiveDrop reason) {
  counts_.dropped[static_cast<std::size_t>(reason)] += arrived_.size() + queued_.size();
  arrived_.clear();
  queued_.clear();
}

LiveCamera::InfoState LiveCamera::find_info(const Waiting& waiting, std::int64_t now) {
  const std::int64_t stamp = waiting.image.header().stamp;
  // An image without a stamp has no camera_info of its own. The queue drops it.
  if (stamp <= 0 || !pairs_.are_likely() || pairs_.covers(stamp)) return InfoState::known;
  if (now - waiting.arrived < companion_wait) return InfoState::awaited;
  if (pairs_.are_certain()) return InfoState::missing;
  pairs_.note_missing();
  return InfoState::known;
}

void LiveCamera::admit(std::int64_t now) {
  while (setup_ && !arrived_.empty()) {
    const InfoState state = find_info(arrived_.front(), now);
    if (state == InfoState::awaited) return;
    Waiting waiting = std::move(arrived_.front());
    arrived_.pop_front();
    if (state == InfoState::missing) {
      ++without_info_;
      drop(LiveDrop::no_camera_info);
      continue;
    }
    without_info_ = 0;
    const std::int64_t stamp = waiting.image.header().stamp;
    const std::uint64_t key = next_key_++;
    queued_.emplace(key, std::move(waiting));
    setup_->queue.push(key, stamp, now);
  }
}

bool LiveCamera::next(std::int64_t now, bool with_color, LiveJob& job) {
  admit(now);
  if (!setup_ || !setup_->queue.next(now, job.pose)) return false;
  Waiting waiting = std::move(queued_.extract(job.pose.key).mapped());
  job.setup = setup_;
  job.image = std::move(waiting.image);
  job.arrived = waiting.arrived;
  job.targets = setup_->targets.take();
  if (setup_->cameras.depth && has_pose(job.pose.pose.status))
    setup_->posed->history.transforms().at(job.pose.pose_stamp, setup_->cameras.judged.frame_id,
                                           depth_frame_, job.T_judged_depth);
  const KeptImage* const color = with_color ? colors_.find(job.pose.stamp) : nullptr;
  job.color.reset();
  if (color != nullptr) job.color = *color;
  colors_.forget_before(job.pose.stamp);
  ++counts_.in_work;
  return true;
}

void LiveCamera::done(const LiveOutcome& outcome) {
  --counts_.in_work;
  ++(outcome.is_published ? counts_.judged : counts_.failed);
  targets_.discarded += outcome.unjudged_targets;
}

std::optional<std::int64_t> LiveCamera::wake_at() const {
  std::optional<std::int64_t> first;
  if (setup_) first = setup_->queue.wake_at();
  if (!arrived_.empty()) {
    const std::int64_t alone = arrived_.front().arrived + companion_wait;
    first = std::min(first.value_or(alone), alone);
  }
  return first;
}

std::optional<std::int64_t> LiveCamera::depth_period() const {
  if (intervals_.empty()) return std::nullopt;
  return *std::min_element(intervals_.begin(), intervals_.end());
}

LiveTargets LiveCamera::targets() const {
  LiveTargets all = targets_;
  if (setup_) {
    all.replaced += setup_->targets.replaced();
    all.discarded += setup_->targets.discarded();
  }
  return all;
}

LiveCounts LiveCamera::counts() const {
  LiveCounts counts = counts_;
  counts.waiting = arrived_.size() + queued_.size();
  return counts;
}

}  // namespace penumbra::io
