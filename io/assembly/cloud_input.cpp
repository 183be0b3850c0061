// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>

#include <io/assembly/cloud_input.hpp>
#include <io/files/printable.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::io {
namespace {

/// Of targets after their cloud, nanoseconds.
constexpr auto longest_delay = static_cast<std::int64_t>(1e9 * topic_target_history);

}  // namespace

CloudInput::CloudInput(CloudInputOptions options, const RobotInput& robot)
    : options_(std::move(options)), robot_(robot) {}

template <typename M>
std::string CloudInput::take(M message, const SerializedMessage& bytes, std::int64_t now) {
  auto cloud = std::make_shared<ReceivedCloud>();
  if constexpr (requires { message.data; }) {  // the others own their points
    if (bytes.owner) {
      cloud->owner = bytes.owner;
    } else {
      const auto copy =
          std::make_shared<std::vector<std::byte>>(message.data.begin(), message.data.end());
      message.data = *copy;
      cloud->owner = copy;
    }
  }
  cloud->header = message.header;
  cloud->arrived = now;
  cloud->message = std::move(message);
  cloud->source_message =
      read_points(std::get<M>(cloud->message), options_.use_times, cloud->points);
  std::string fault = options_.known ? "" : cloud->source_message;
  push(std::move(cloud), now);
  return fault;
}
template std::string CloudInput::take(PointCloud2Message, const SerializedMessage&, std::int64_t);
template std::string CloudInput::take(LaserScanMessage, const SerializedMessage&, std::int64_t);
template std::string CloudInput::take(LivoxMessage, const SerializedMessage&, std::int64_t);

void CloudInput::push(std::shared_ptr<ReceivedCloud> cloud, std::int64_t now) {
  ++counts_.received;
  arrivals_.add(now);
  std::string frame(frame_name(cloud->header.frame_id));
  if (!options_.known) {
    frame_ = std::move(frame);
    refresh();
    if (!setup_) return counts_.drop(DropReason::not_ready);
    if (!cloud->source_message.empty()) return counts_.drop(DropReason::unreadable);
  } else {
    if (cloud->source_message.empty() && !frame_.empty() && frame != frame_)
      cloud->source_message = "the cloud is of the frame '" + printable(frame) +
                              "', the first one of '" + printable(frame_) + "'";
    if (!setup_) {
      frame_ = std::move(frame);
      setup_ = make_setup(*options_.known);
    }
    if (!cloud->source_message.empty()) return lost_.push_back(std::move(cloud));
  }
  const auto& times = cloud->points.times;
  const std::int32_t last = times.empty() ? 0 : *std::max_element(times.begin(), times.end());
  cloud->stamp = cloud->header.stamp > 0 ? stamp_after(cloud->header.stamp, last) : 0;
  setup_->queue.push(std::move(cloud), now);
}

void CloudInput::refresh() {
  if (options_.known) return;
  Basis basis{.robot = robot_.posed().get(), .frames = robot_.frames_revision(), .frame = frame_};
  if (basis == basis_) return;
  const bool only_frames_are_new =
      setup_ && basis.robot == basis_.robot && basis.frame == basis_.frame;
  basis_ = std::move(basis);
  setup_fault_.clear();
  std::optional<CameraMount> mount;
  try {
    mount = find_mount();
  } catch (const InputError& error) {
    setup_fault_ = error.what();
  }
  if (only_frames_are_new && mount && *mount == setup_->mount) return;
  if (setup_) counts_.drop(DropReason::changed, setup_->queue.waiting());
  given_.clear();
  targets_.clear();  // of frames that may be others now
  setup_ = mount ? make_setup(std::move(*mount)) : nullptr;
}

std::optional<CameraMount> CloudInput::find_mount() const {
  if (!robot_.posed() || frame_.empty()) return std::nullopt;
  const Robot& robot = robot_.posed()->robot;
  if (!options_.is_in_other_frame() &&
      is_above_robot(robot, options_.mount, robot_.frames(), frame_))
    throw InputError("the clouds are given in frame '" + printable(frame_) +
                     "', above the robot, and not in their sensor's: name that as sensor_frame, or "
                     "say that the clouds are merged");
  return io::find_mount(robot, options_.mount, robot_.frames(), frame_)
      .value_or(mount_by_root(robot, options_.mount, frame_));
}

std::shared_ptr<CloudSetup> CloudInput::make_setup(CameraMount mount) {
  const FrameQueueOptions queue{.policy = options_.known ? DropPolicy::every : DropPolicy::newest,
                                .time_offset = options_.time_offset,
                                .max_wait = options_.max_wait,
                                .max_frames = options_.max_frames,
                                .poses = {.source = options_.poses,
                                          .frame_prefix = options_.mount.frame_prefix,
                                          .camera_parent = mount.parent,
                                          .camera_frame = mount.frame}};
  return std::make_shared<CloudSetup>(
      robot_.posed(), std::move(mount), frame_, queue, options_.hidden_targets,
      [this](std::shared_ptr<Frame> cloud, DropReason reason) {
        if (!options_.known) return counts_.drop(reason);
        cloud->source_message = "not labelled: " + std::string(to_string(reason));
        lost_.push_back(std::static_pointer_cast<ReceivedCloud>(std::move(cloud)));
      });
}

void CloudInput::finish() {
  if (setup_) setup_->queue.finish();
}

std::shared_ptr<ReceivedCloud> CloudInput::next(std::int64_t now) {
  std::shared_ptr<ReceivedCloud> found;
  if (!lost_.empty()) {
    found = std::move(lost_.front());
    lost_.pop_front();
  } else if (setup_) {
    found = std::static_pointer_cast<ReceivedCloud>(setup_->queue.next(now));
  }
  if (!found) return find_again();
  found->setup = setup_;
  ++counts_.in_work;
  if (!options_.has_targets) return found;
  receive_targets();
  give_targets(*found);
  given_.push_back(found);
  std::erase_if(given_, [&](const auto& former) {  // also of a clock that jumped back
    return std::abs(former->header.stamp - found->header.stamp) > longest_delay;
  });
  return found;
}

/// Takes the targets whose clouds are not past.
void CloudInput::receive_targets() {
  for (Target& target : setup_->targets.take()) targets_.push_back(std::move(target));
  late_targets_ += std::erase_if(targets_, [&](const Target& target) {
    return !given_.empty() && target.stamp > 0 && *target.stamp < given_.front()->header.stamp;
  });
  if (targets_.size() > TargetInbox::most_waiting) targets_.clear();  // of another clock
}

/// Moves a cloud's targets to it. Those without a stamp, which have a fault, are any cloud's.
void CloudInput::give_targets(ReceivedCloud& cloud) {
  const auto is_other = [&](const Target& target) {
    return target.stamp > 0 && target.stamp != cloud.header.stamp;
  };
  const auto own = std::stable_partition(targets_.begin(), targets_.end(), is_other);
  cloud.targets.assign(std::move_iterator(own), std::move_iterator(targets_.end()));
  targets_.erase(own, targets_.end());
}

std::shared_ptr<ReceivedCloud> CloudInput::find_again() {
  if (!setup_ || !options_.has_targets) return nullptr;
  receive_targets();
  for (const auto& cloud : given_) {
    give_targets(*cloud);
    cloud->is_again = true;
    if (!cloud->targets.empty()) return cloud;
  }
  return nullptr;
}

void CloudInput::done(bool is_labelled) {
  --counts_.in_work;
  ++(is_labelled ? counts_.judged : counts_.failed);
}

ImageCounts CloudInput::counts() const {
  ImageCounts counts = counts_;
  counts.waiting = (setup_ ? setup_->queue.waiting() : 0) + lost_.size();
  return counts;
}

}  // namespace penumbra::io
