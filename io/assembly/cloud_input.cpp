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

PoseOptions pose_options(const CloudInputOptions& options) {
  return {.source = options.poses,
          .frame_prefix = options.frame_prefix,
          .camera_parent = options.mount.parent,
          .camera_frame = options.mount.frame};
}

}  // namespace

CloudInput::CloudInput(CloudInputOptions options, std::shared_ptr<PosedRobot> posed)
    : options_(std::move(options)),
      posed_(std::move(posed)),
      queue_(posed_->robot, posed_->history,
             {.policy = DropPolicy::every,
              .time_offset = options_.time_offset,
              .max_wait = options_.max_wait,
              .max_frames = options_.max_frames,
              .poses = pose_options(options_)},
             [this](std::shared_ptr<Frame> cloud, DropReason reason) {
               keep_lost(std::move(cloud), "not labelled: " + std::string(to_string(reason)));
             }),
      lookup_(posed_->robot, pose_options(options_)),
      pipeline_(posed_->robot, {.rule = options_.rule,
                                .threads = options_.threads,
                                .sensor_parent = options_.mount.parent,
                                .T_parent_sensor = options_.mount.T_parent_camera}) {}

template <typename M>
void CloudInput::take(M message, const SerializedMessage& bytes, std::int64_t now) {
  auto cloud = std::make_shared<ReceivedCloud>();
  if constexpr (requires { message.data; }) {  // the others own their points
    cloud->payload.assign(bytes.data.begin(), bytes.data.end());
    const auto at = message.data.empty() ? 0 : message.data.data() - bytes.data.data();
    message.data = std::span<const std::byte>(cloud->payload)
                       .subspan(static_cast<std::size_t>(at), message.data.size());
  }
  cloud->header = message.header;
  cloud->arrived = now;
  cloud->message = std::move(message);
  cloud->source_message =
      read_points(std::get<M>(cloud->message), options_.use_times, cloud->points);
  push(std::move(cloud), now);
}
template void CloudInput::take(PointCloud2Message, const SerializedMessage&, std::int64_t);
template void CloudInput::take(LaserScanMessage, const SerializedMessage&, std::int64_t);
template void CloudInput::take(LivoxMessage, const SerializedMessage&, std::int64_t);

void CloudInput::push(std::shared_ptr<ReceivedCloud> cloud, std::int64_t now) {
  const std::string frame(frame_name(cloud->header.frame_id));
  if (cloud->source_message.empty() && !frame_.empty() && frame != frame_)
    cloud->source_message = "the cloud is of the frame '" + printable(frame) +
                            "', the first one of '" + printable(frame_) + "'";
  if (frame_.empty()) frame_ = frame;
  if (!cloud->source_message.empty()) return keep_lost(cloud, cloud->source_message);
  const auto& times = cloud->points.times;
  const std::int32_t last = times.empty() ? 0 : *std::max_element(times.begin(), times.end());
  cloud->stamp = cloud->header.stamp > 0 ? stamp_after(cloud->header.stamp, last) : 0;
  queue_.push(std::move(cloud), now);
}

void CloudInput::keep_lost(std::shared_ptr<Frame> cloud, const std::string& why) {
  cloud->source_message = why;
  lost_.push_back(std::static_pointer_cast<ReceivedCloud>(std::move(cloud)));
}

std::shared_ptr<ReceivedCloud> CloudInput::next(std::int64_t now) {
  if (!lost_.empty()) {
    auto first = std::move(lost_.front());
    lost_.pop_front();
    return first;
  }
  return std::static_pointer_cast<ReceivedCloud>(queue_.next(now));
}

const CloudReport& CloudInput::label(const ReceivedCloud& cloud) {
  Scan scan{
      .stamp = cloud.header.stamp, .points = cloud.points.points, .times = cloud.points.times};
  std::string fault = cloud.source_message;
  if (!options_.has_rays) {
    scan.origin.reset();
  } else if (!options_.sensor_frame.empty() && fault.empty()) {
    TransformAnswer sensor;
    posed_->history.transforms().at(queue_.pose_stamp(cloud.header.stamp), frame_,
                                    options_.sensor_frame, sensor);
    if (sensor.status == TransformStatus::ok)
      scan.origin = sensor.T_target_source.translation();
    else
      fault = sensor.message;
  }
  return pipeline_.process(scan, [&](std::int64_t stamp, RobotPose& pose) {
    if (fault.empty())
      lookup_.at(posed_->history, queue_.pose_stamp(stamp), pose);
    else
      pose = {.status = FrameStatus::missing_transform, .message = fault};
  });
}

}  // namespace penumbra::io
