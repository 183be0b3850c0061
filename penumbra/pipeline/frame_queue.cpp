// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra {
namespace {

constexpr std::uint64_t never_tried = std::numeric_limits<std::uint64_t>::max();

}  // namespace

std::string_view to_string(DropReason reason) {
  constexpr std::array<std::string_view, drop_reasons> names = {
      "superseded", "late",      "overflow", "clock_jump",    "no_stamp",
      "unreadable", "not_ready", "changed",  "no_camera_info"};
  return names[static_cast<std::size_t>(reason)];
}

FrameQueue::FrameQueue(const Robot& robot, PoseHistory& history, const FrameQueueOptions& options,
                       OnDrop on_drop)
    : history_(history),
      options_(options),
      time_offset_(span_nanoseconds(options.time_offset, "frame queue: time_offset", -1e9)),
      max_wait_(span_nanoseconds(options.max_wait, "frame queue: max_wait")),
      lookup_(robot, options.poses),
      on_drop_(std::move(on_drop)),
      epoch_(history.epoch()) {
  if (options_.max_frames == 0)
    throw InputError("frame queue: max_frames is 0; expected at least 1");
}

void FrameQueue::push(std::uint64_t key, std::int64_t stamp, std::int64_t now) {
  follow(now);
  ++counts_.pushed;
  const Waiting frame{key, stamp, now, never_tried};
  if (stamp <= 0) return drop(frame, DropReason::no_stamp);
  if (newest_ && history_.note_stamp(stamp, *newest_, "depth images")) follow(now);
  newest_ = std::max(newest_.value_or(stamp), stamp);
  if (!first_) first_ = pose_stamp(stamp);
  if (options_.policy == DropPolicy::every) {
    if (waiting_.size() == options_.max_frames) return drop(frame, DropReason::overflow);
    waiting_.push_back(frame);
    return;
  }
  if (given_out_ && stamp <= *given_out_) return drop(frame, DropReason::late);
  const auto later = [](std::int64_t wanted, const Waiting& other) { return wanted < other.stamp; };
  waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), stamp, later), frame);
  if (waiting_.size() <= options_.max_frames) return;
  drop(waiting_.front(), DropReason::overflow);
  waiting_.erase(waiting_.begin());
}

void FrameQueue::follow(std::int64_t now) {
  now_ = now;
  for (Waiting& frame : waiting_) frame.arrived = std::min(frame.arrived, now);
  if (epoch_ == history_.epoch()) return;
  epoch_ = history_.epoch();
  newest_.reset();
  first_.reset();
  given_out_.reset();
  for (const Waiting& frame : waiting_) drop(frame, DropReason::clock_jump);
  waiting_.clear();
}

void FrameQueue::drop(const Waiting& frame, DropReason reason) {
  ++counts_.dropped[static_cast<std::size_t>(reason)];
  if (on_drop_) on_drop_({frame.key, frame.stamp, reason});
}

std::int64_t FrameQueue::pose_stamp(std::int64_t stamp) const {
  return stamp_after(stamp, time_offset_);
}

std::optional<std::uint64_t> FrameQueue::next(std::int64_t now, Frame& frame) {
  follow(now);
  const auto key = options_.policy == DropPolicy::every ? next_in_order(frame) : next_newest(frame);
  if (!key) return key;
  ++counts_.given_out;
  if (!has_pose(frame.pose.status)) ++counts_.without_pose;
  given_out_ = std::max(given_out_.value_or(*frame.stamp), *frame.stamp);
  return key;
}

std::optional<std::uint64_t> FrameQueue::next_in_order(Frame& out) {
  if (waiting_.empty() || !decide(waiting_.front(), out)) return std::nullopt;
  const std::uint64_t key = waiting_.front().key;
  waiting_.erase(waiting_.begin());
  return key;
}

std::optional<std::uint64_t> FrameQueue::next_newest(Frame& out) {
  for (auto frame = waiting_.end(); frame != waiting_.begin();) {
    if (!decide(*--frame, out)) continue;
    for (auto before = waiting_.begin(); before != frame; ++before)
      drop(*before, DropReason::superseded);
    const std::uint64_t key = frame->key;
    waiting_.erase(waiting_.begin(), frame + 1);
    return key;
  }
  return std::nullopt;
}

bool FrameQueue::is_over(const Waiting& frame) const {
  const bool full = options_.policy == DropPolicy::every && waiting_.size() == options_.max_frames;
  return finished_ || full ||
         stamp_distance(frame.arrived, now_) >= static_cast<std::uint64_t>(max_wait_);
}

/// Whether states of an uncertain robot may still come in time. A robot that has been silent for
/// max_wait does not delay the others.
bool FrameQueue::awaits_robot(std::int64_t at) const {
  const auto since = lookup_.late_since();
  return since &&
         stamp_distance(std::max(*since, *first_), at) <= static_cast<std::uint64_t>(max_wait_);
}

bool FrameQueue::decide(Waiting& frame, Frame& out) {
  const bool over = is_over(frame);
  if (frame.revision == history_.revision() && !over) return false;
  frame.revision = history_.revision();
  const std::int64_t at = pose_stamp(frame.stamp);
  lookup_.at(history_, at, out.pose);
  const bool known = out.pose.status == FrameStatus::poses_disagree ||
                     (has_pose(out.pose.status) && !awaits_robot(at));
  if (!known && !over) return false;
  out.stamp = frame.stamp;
  return true;
}

std::optional<std::int64_t> FrameQueue::wake_at() const {
  std::optional<std::int64_t> first;
  for (const Waiting& frame : waiting_) {
    const std::int64_t over = stamp_after(frame.arrived, max_wait_);
    first = std::min(first.value_or(over), over);
  }
  return first;
}

FrameCounts FrameQueue::counts() const {
  FrameCounts counts = counts_;
  counts.waiting = waiting_.size();
  return counts;
}

}  // namespace penumbra
