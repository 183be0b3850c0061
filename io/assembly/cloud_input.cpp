// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/assembly/cloud_input.hpp>
#include <io/files/printable.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::io {

CloudInput::CloudInput(CloudInputOptions options, const RobotInput& robot)
    : SensorInput(robot, "cloud", options.poses, options.known.has_value()),
      options_(std::move(options)) {
  if (!options_.known) return;
  frame_ = options_.known_frame;
  setup_ = make_setup(*options_.known);
}

template <typename M>
std::string CloudInput::take(M message, const SerializedMessage& bytes, std::int64_t now) {
  const auto frame = begin(now);
  const auto cloud = std::make_shared<ReceivedCloud>();
  cloud->owner = bytes.owner;
  if constexpr (requires { message.data; })  // the others own their points
    if (!cloud->owner) {
      const auto copy =
          std::make_shared<std::vector<std::byte>>(message.data.begin(), message.data.end());
      message.data = *copy;
      cloud->owner = copy;
    }
  if (message.header.stamp > 0) frame->stamp = message.header.stamp;
  cloud->frame_id = frame_name(message.header.frame_id);
  cloud->arrived = now;
  cloud->message = std::move(message);
  frame->source_message =
      read_points(std::get<M>(cloud->message), options_.use_times, cloud->points);
  if (!frame->source_message.empty()) frame->source_status = FrameStatus::bad_depth;
  frame->scan = scan_of(cloud, options_.has_rays);

  const std::string& fault = frame->source_message;
  if (!is_lossless()) {
    frame_ = cloud->frame_id;
    refresh();
    if (!setup_)
      counts_.drop(DropReason::not_ready);
    else if (!fault.empty())
      counts_.drop(DropReason::unreadable);
    else
      push(frame, now);
    return fault;
  }
  if (fault.empty() && !frame_.empty() && cloud->frame_id != frame_) {
    frame->source_status = FrameStatus::missing_transform;
    frame->source_message = "the cloud is of the frame '" + printable(cloud->frame_id) +
                            "', expected '" + printable(frame_) + "'";
  }
  push(frame, now);
  return {};
}
template std::string CloudInput::take(PointCloud2Message, const SerializedMessage&, std::int64_t);
template std::string CloudInput::take(LaserScanMessage, const SerializedMessage&, std::int64_t);
template std::string CloudInput::take(LivoxMessage, const SerializedMessage&, std::int64_t);

std::shared_ptr<SensorSetup> CloudInput::find_setup() {
  if (!robot_.posed() || frame_.empty()) return nullptr;
  const Robot& robot = robot_.posed()->robot;
  if (!options_.is_in_other_frame() &&
      is_above_robot(robot, options_.mount, robot_.frames(), frame_))
    throw InputError("the clouds are given in frame '" + printable(frame_) +
                     "', above the robot, and not in their sensor's: name that as sensor_frame, or "
                     "say that the clouds are merged");
  return make_setup(find_mount(robot, options_.mount, robot_.frames(), frame_)
                        .value_or(mount_by_root(robot, options_.mount, frame_)));
}

std::shared_ptr<SensorSetup> CloudInput::make_setup(CameraMount mount) {
  CloudConfig config{.rule = options_.rule,
                     .threads = options_.threads,
                     .sensor_parent = mount.parent,
                     .T_parent_sensor = mount.T_parent_camera,
                     .target_history = options_.has_targets ? topic_target_history : 0.0};
  return SensorInput::make_setup(options_, std::move(config), std::move(mount), frame_, 0.0);
}

/// Adds where a scan's rays start if that is not the points' frame.
void CloudInput::complete(AssembledFrame& frame) {
  SensorSetup& setup = *frame.setup;
  if (options_.sensor_frame.empty() || frame.source_status != FrameStatus::ok) return;
  TransformAnswer sensor;
  setup.posed->history.transforms().at(setup.queue.pose_stamp(frame.stamp.value_or(0)),
                                       frame.scan->received->frame_id, options_.sensor_frame,
                                       sensor);
  if (sensor.status == TransformStatus::ok) {
    frame.scan->origin = sensor.T_target_source.translation();
  } else {
    frame.source_status = FrameStatus::missing_transform;
    frame.source_message = sensor.message;
  }
}

}  // namespace penumbra::io
