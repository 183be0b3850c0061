// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/sensor_input.hpp>

namespace penumbra::io {

std::shared_ptr<AssembledFrame> SensorInput::begin(std::int64_t now) {
  auto frame = std::make_shared<AssembledFrame>();
  frame->index = counts_.received++;
  frame->arrived = now;
  arrivals_.add(now);
  return frame;
}

void SensorInput::push(std::shared_ptr<AssembledFrame> frame, std::int64_t now) {
  setup_->queue.push(std::move(frame), now);
}

void SensorInput::refresh() {
  if (is_lossless_) return;
  Basis basis{.robot = robot_.posed().get(),
              .frames = robot_.frames_revision(),
              .cameras = camera_infos_,
              .frame = frame_};
  if (basis == basis_) return;
  const bool only_frames_are_new = setup_ && basis.robot == basis_.robot &&
                                   basis.cameras == basis_.cameras && basis.frame == basis_.frame;
  basis_ = std::move(basis);
  setup_fault_.clear();
  std::shared_ptr<SensorSetup> made;
  try {
    made = find_setup();
  } catch (const InputError& error) {
    setup_fault_ = error.what();
  }
  if (only_frames_are_new && made && made->mount == setup_->mount) return;
  if (setup_) {
    counts_.drop(DropReason::changed, setup_->queue.waiting());
    counts_.targets_replaced += setup_->targets.replaced();
    counts_.targets_discarded += setup_->targets.discarded() + setup_->targets.waiting();
  }
  setup_ = std::move(made);
}

void SensorInput::drop(std::shared_ptr<Frame> frame, DropReason reason) {
  if (!is_lossless_) {
    counts_.drop(reason);
    without_info_ += reason == DropReason::no_camera_info ? 1 : 0;
  } else if (reason == DropReason::no_stamp) {
    keep_without_pose(std::move(frame),
                      "the " + name_ + "'s stamp is 0: it is not known when it was taken");
  } else if (reason == DropReason::clock_jump) {
    keep_without_pose(std::move(frame),
                      "the clock jumped back while the " + name_ + " waited for its pose");
  } else {
    keep_without_pose(std::move(frame), "too many " + name_ + "s waited for their poses");
  }
}

void SensorInput::keep_without_pose(std::shared_ptr<Frame> frame, const std::string& why) {
  if (frame->stamp.value_or(0) <= 0) frame->stamp.reset();
  frame->pose = {.status = poses_ == PoseSource::transforms ? FrameStatus::missing_transform
                                                            : FrameStatus::missing_joints,
                 .message = why};
  without_pose_.push_back(std::move(frame));
}

void SensorInput::finish() {
  if (setup_) setup_->queue.finish();
}

bool SensorInput::next(std::int64_t now, bool with_color, AssembledFrame& next) {
  with_color_ = with_color;
  const auto is_without_pose = [this] {
    const Frame* const first = setup_ ? setup_->queue.first() : nullptr;
    return !without_pose_.empty() &&
           (first == nullptr || without_pose_.front()->index < first->index);
  };
  std::shared_ptr<Frame> found;
  if (setup_ && !is_without_pose()) found = setup_->queue.next(now);
  if (!found && is_without_pose()) {
    found = std::move(without_pose_.front());
    without_pose_.pop_front();
  }
  if (!found) return false;
  without_info_ = 0;
  next = std::move(static_cast<AssembledFrame&>(*found));
  next.setup = setup_;
  if (next.stamp) next.targets = setup_->targets.take(*next.stamp);
  complete(next);
  ++counts_.in_work;
  return true;
}

void SensorInput::done(bool is_judged, std::size_t unjudged_targets) {
  --counts_.in_work;
  ++(is_judged ? counts_.judged : counts_.failed);
  counts_.targets_discarded += unjudged_targets;
}

ImageCounts SensorInput::counts() const {
  ImageCounts counts = counts_;
  counts.waiting = without_pose_.size();
  if (!setup_) return counts;
  counts.waiting += setup_->queue.waiting();
  counts.targets_replaced += setup_->targets.replaced();
  counts.targets_discarded += setup_->targets.discarded();
  return counts;
}

}  // namespace penumbra::io
