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
  constexpr std::array<std::string_view, 5> names = {"superseded", "late", "overflow", "clock_jump",
                                                     "no_stamp"};
  return names[static_cast<std::size_t>(reason)];
}

Frame QueuedFrame::frame() const {
  Frame frame;
  frame.stamp = stamp;
  frame.source_status = pose.status;
  frame.source_message = pose.message;
  if (pose.status != FrameStatus::ok) return frame;
  if (pose.by_joints)
    frame.joints = pose.joints;
  else
    frame.T_root_link = pose.T_root_link;
  frame.joints.age = pose.age;
  frame.T_parent_camera = pose.T_parent_camera;
  frame.uncertain_links = pose.uncertain_links;
  frame.uncertain_reason = pose.uncertain_reason;
  frame.attached = pose.attached;
  return frame;
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
  if (!first_) first_ = stamp_after(stamp, time_offset_);
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

bool FrameQueue::next(std::int64_t now, QueuedFrame& frame) {
  follow(now);
  const bool found =
      options_.policy == DropPolicy::every ? next_in_order(frame) : next_newest(frame);
  if (!found) return false;
  ++counts_.given_out;
  if (!has_pose(frame.pose.status)) ++counts_.without_pose;
  given_out_ = std::max(given_out_.value_or(frame.stamp), frame.stamp);
  return true;
}

bool FrameQueue::next_in_order(QueuedFrame& out) {
  if (waiting_.empty() || !decide(waiting_.front(), out)) return false;
  waiting_.erase(waiting_.begin());
  return true;
}

bool FrameQueue::next_newest(QueuedFrame& out) {
  for (auto frame = waiting_.end(); frame != waiting_.begin();) {
    if (!decide(*--frame, out)) continue;
    for (auto before = waiting_.begin(); before != frame; ++before)
      drop(*before, DropReason::superseded);
    waiting_.erase(waiting_.begin(), frame + 1);
    return true;
  }
  return false;
}

bool FrameQueue::is_over(const Waiting& frame) const {
  const bool full = options_.policy == DropPolicy::every && waiting_.size() == options_.max_frames;
  return finished_ || full ||
         stamp_distance(frame.arrived, now_) >= static_cast<std::uint64_t>(max_wait_);
}

/// Whether states of an uncertain robot may still come in time. A robot that has been silent for
/// max_wait does not delay the others.
bool FrameQueue::awaits_robot(const QueuedFrame& frame) const {
  const auto& since = frame.pose.late_since;
  return since && stamp_distance(std::max(*since, *first_), frame.pose_stamp) <=
                      static_cast<std::uint64_t>(max_wait_);
}

bool FrameQueue::decide(Waiting& frame, QueuedFrame& out) {
  const bool over = is_over(frame);
  if (frame.revision == history_.revision() && !over) return false;
  frame.revision = history_.revision();
  out.pose_stamp = stamp_after(frame.stamp, time_offset_);
  lookup_.at(history_, out.pose_stamp, out.pose);
  const bool known = out.pose.status == FrameStatus::poses_disagree ||
                     (has_pose(out.pose.status) && !awaits_robot(out));
  if (!known && !over) return false;
  out.key = frame.key;
  out.stamp = frame.stamp;
  out.waited = static_cast<std::int64_t>(std::min<std::uint64_t>(
      stamp_distance(frame.arrived, now_), std::numeric_limits<std::int64_t>::max()));
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
