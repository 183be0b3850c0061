// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra {
namespace {

constexpr std::uint64_t never_tried = std::numeric_limits<std::uint64_t>::max();

/// Returns the stamp of a frame's last measurement; 0: it has no stamp.
std::int64_t end_of(const Frame& frame) {
  const std::int64_t stamp = frame.stamp.value_or(0);
  if (stamp <= 0 || !frame.scan || frame.scan->times.empty()) return stamp;
  return stamp_after(stamp, std::ranges::max(frame.scan->times));
}

}  // namespace

std::string_view to_string(DropReason reason) {
  constexpr std::array<std::string_view, drop_reasons> names = {
      "superseded", "late",      "overflow", "clock_jump",    "no_stamp",
      "unreadable", "not_ready", "changed",  "no_camera_info"};
  return names[static_cast<std::size_t>(reason)];
}

FrameQueue::FrameQueue(const Robot& robot, PoseHistory& history, const FrameQueueOptions& options,
                       OnDrop on_drop, Check check)
    : history_(history),
      options_(options),
      time_offset_(span_nanoseconds(options.time_offset, "frame queue: time_offset", -1e9)),
      max_wait_(span_nanoseconds(options.max_wait, "frame queue: max_wait")),
      companion_wait_(span_nanoseconds(options.companion_wait, "frame queue: companion_wait")),
      lookup_(robot, options.poses),
      on_drop_(on_drop ? std::move(on_drop) : [](const auto&, DropReason) {}),
      check_(check ? std::move(check)
                   : [](const Frame&, bool /*over*/) { return Companions::complete; }),
      epoch_(history.epoch()) {
  if (options_.max_frames == 0)
    throw InputError("frame queue: max_frames is 0; expected at least 1");
}

void FrameQueue::push(std::shared_ptr<Frame> frame, std::int64_t now) {
  follow(now);
  const std::int64_t stamp = end_of(*frame);
  if (stamp <= 0) return on_drop_(std::move(frame), DropReason::no_stamp);
  if (newest_ && history_.note_stamp(stamp, *newest_, frame->scan ? "clouds" : "depth images"))
    follow(now);
  newest_ = std::max(newest_.value_or(stamp), stamp);
  if (!first_) first_ = pose_stamp(stamp);
  const bool every = options_.policy == DropPolicy::every;
  if (every && waiting_.size() == options_.max_frames)
    return on_drop_(std::move(frame), DropReason::overflow);
  if (!every && given_out_ && stamp <= *given_out_)
    return on_drop_(std::move(frame), DropReason::late);
  const auto later = [](std::int64_t wanted, const Waiting& other) { return wanted < other.stamp; };
  const auto place =
      every ? waiting_.end() : std::upper_bound(waiting_.begin(), waiting_.end(), stamp, later);
  waiting_.insert(place, {std::move(frame), stamp, now, never_tried});
  if (waiting_.size() <= options_.max_frames) return;
  on_drop_(std::move(waiting_.front().frame), DropReason::overflow);
  waiting_.erase(waiting_.begin());
}

void FrameQueue::follow(std::int64_t now) {
  now_ = now;
  for (Waiting& waiting : waiting_) waiting.arrived = std::min(waiting.arrived, now);
  if (epoch_ == history_.epoch()) return;
  epoch_ = history_.epoch();
  newest_.reset();
  first_.reset();
  given_out_.reset();
  std::erase_if(waiting_, [this](Waiting& waiting) {
    if (options_.policy == DropPolicy::every && waiting.has_result) return false;
    on_drop_(std::move(waiting.frame), DropReason::clock_jump);
    return true;
  });
}

std::int64_t FrameQueue::pose_stamp(std::int64_t stamp) const {
  return stamp_after(stamp, time_offset_);
}

std::shared_ptr<Frame> FrameQueue::next(std::int64_t now) {
  follow(now);
  if (options_.policy == DropPolicy::every)  // before the clock jumps
    for (Waiting& waiting : waiting_) find_pose(waiting);
  const auto found = find_next();
  if (found == waiting_.end()) return nullptr;
  for (auto before = waiting_.begin(); before != found; ++before)
    on_drop_(std::move(before->frame), DropReason::superseded);
  std::shared_ptr<Frame> frame = std::move(found->frame);
  given_out_ = std::max(given_out_.value_or(found->stamp), found->stamp);
  const bool is_sweep = found->stamp != *frame->stamp;
  waiting_.erase(waiting_.begin(), found + 1);
  const bool is_of_bag = options_.policy == DropPolicy::every && !frame->scan;
  if (!is_of_bag && !(is_sweep && has_pose(frame->pose.status))) return frame;
  frame->pose_at = [this](std::int64_t stamp, RobotPose& pose) {
    lookup_.at(history_, pose_stamp(stamp), pose);
  };
  if (is_sweep) frame->pose_at(*frame->stamp, frame->pose);  // so far that of the last point
  return frame;
}

/// Returns the first frame (every) or the newest one that is decided.
std::vector<FrameQueue::Waiting>::iterator FrameQueue::find_next() {
  const bool every = options_.policy == DropPolicy::every;
  for (std::size_t left = waiting_.size(); left-- > 0;) {
    const auto waiting =
        every ? waiting_.begin() : waiting_.begin() + static_cast<std::ptrdiff_t>(left);
    const Companions companions = decide(*waiting);
    if (companions == Companions::complete) return waiting;
    if (companions == Companions::missing) {
      on_drop_(std::move(waiting->frame), DropReason::no_camera_info);
      waiting_.erase(waiting);
    } else if (every) {
      break;
    }
  }
  return waiting_.end();
}

bool FrameQueue::is_over(const Waiting& waiting, std::int64_t max_wait) const {
  const bool is_first = options_.policy == DropPolicy::every && &waiting == waiting_.data();
  return finished_ || (is_first && waiting_.size() == options_.max_frames) ||
         stamp_distance(waiting.arrived, now_) >= static_cast<std::uint64_t>(max_wait);
}

/// Whether states of uncertain links may still come in time. What has been silent for
/// max_wait does not delay the others.
bool FrameQueue::awaits_links(std::int64_t at) const {
  const auto since = lookup_.late_since();
  return since &&
         stamp_distance(std::max(*since, *first_), at) <= static_cast<std::uint64_t>(max_wait_);
}

/// A frame is decided if its pose and its companions are, or are no longer awaited.
Companions FrameQueue::decide(Waiting& waiting) {
  find_pose(waiting);
  return waiting.has_result ? check_(*waiting.frame, is_over(waiting, companion_wait_))
                            : Companions::awaited;
}

void FrameQueue::find_pose(Waiting& waiting) {
  if (waiting.has_result) return;
  const bool over = is_over(waiting, max_wait_);
  if (waiting.revision == history_.revision() && !over) return;
  waiting.revision = history_.revision();
  const std::int64_t at = pose_stamp(waiting.stamp);
  RobotPose& pose = waiting.frame->pose;
  lookup_.at(history_, at, pose);
  waiting.has_result = over || pose.status == FrameStatus::poses_disagree ||
                       (has_pose(pose.status) && !awaits_links(at));
}

std::optional<std::int64_t> FrameQueue::wake_at() const {
  std::optional<std::int64_t> first;
  for (const Waiting& waiting : waiting_) {
    const std::int64_t over =
        stamp_after(waiting.arrived, waiting.has_result ? companion_wait_ : max_wait_);
    first = std::min(first.value_or(over), over);
  }
  return first;
}

}  // namespace penumbra
