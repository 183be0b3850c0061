// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>

#include <io/assembly/cloud_input.hpp>
#include <io/files/printable.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::io {

CloudInput::CloudInput(CloudInputOptions options, const RobotInput& robot)
    : options_(std::move(options)), robot_(robot) {
  refresh();
}

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
  refresh();
  if (!cloud->source_message.empty()) return drop(cloud, cloud->source_message);
  if (!setup_)
    return drop(cloud, setup_fault_.empty() ? "the robot is not known yet" : setup_fault_);
  const auto& times = cloud->points.times;
  const std::int32_t last = times.empty() ? 0 : *std::max_element(times.begin(), times.end());
  cloud->stamp = cloud->header.stamp > 0 ? stamp_after(cloud->header.stamp, last) : 0;
  setup_->queue.push(std::move(cloud), now);
}

void CloudInput::drop(std::shared_ptr<Frame> cloud, const std::string& why) {
  if (options_.policy != DropPolicy::every) return;
  cloud->source_message = why;
  lost_.push_back(std::static_pointer_cast<ReceivedCloud>(std::move(cloud)));
}

void CloudInput::refresh() {
  const std::shared_ptr<PosedRobot>& posed = robot_.posed();
  if (!posed || (frame_.empty() && !options_.known_mount)) {
    setup_.reset();
    return;
  }
  setup_fault_.clear();
  try {
    const CameraMount mount =
        options_.known_mount ? *options_.known_mount
                             : find_mount(posed->robot, options_.mount, robot_.frames(), frame_)
                                   .value_or(mount_by_root(posed->robot, options_.mount, frame_));
    if (!setup_ || setup_->posed != posed || !(setup_->mount == mount)) setup_ = make_setup(mount);
  } catch (const InputError& error) {
    if (options_.known_mount) throw;
    setup_fault_ = error.what();
    setup_.reset();
  }
}

std::unique_ptr<CloudInput::Setup> CloudInput::make_setup(const CameraMount& mount) {
  const std::shared_ptr<PosedRobot>& posed = robot_.posed();
  const PoseOptions poses{.source = options_.poses,
                          .frame_prefix = options_.mount.frame_prefix,
                          .camera_parent = mount.parent,
                          .camera_frame = mount.frame};
  const auto on_drop = [this](std::shared_ptr<Frame> cloud, DropReason reason) {
    drop(std::move(cloud), "not labelled: " + std::string(to_string(reason)));
  };
  return std::make_unique<Setup>(
      Setup{.posed = posed,
            .mount = mount,
            .queue = FrameQueue(posed->robot, posed->history,
                                {.policy = options_.policy,
                                 .time_offset = options_.time_offset,
                                 .max_wait = options_.max_wait,
                                 .max_frames = options_.max_frames,
                                 .poses = poses},
                                on_drop),
            .lookup = PoseLookup(posed->robot, poses),
            .pipeline = CloudPipeline(posed->robot, {.rule = options_.rule,
                                                     .threads = options_.threads,
                                                     .sensor_parent = mount.parent,
                                                     .T_parent_sensor = mount.T_parent_camera})});
}

void CloudInput::finish() {
  if (setup_) setup_->queue.finish();
}

std::shared_ptr<ReceivedCloud> CloudInput::next(std::int64_t now) {
  if (!setup_) return nullptr;
  if (!lost_.empty()) {
    auto first = std::move(lost_.front());
    lost_.pop_front();
    return first;
  }
  return std::static_pointer_cast<ReceivedCloud>(setup_->queue.next(now));
}

const CloudReport& CloudInput::label(const ReceivedCloud& cloud) {
  Setup& s = *setup_;
  Scan scan{
      .stamp = cloud.header.stamp, .points = cloud.points.points, .times = cloud.points.times};
  std::string fault = cloud.source_message;
  if (!options_.has_rays) {
    scan.origin.reset();
  } else if (!options_.sensor_frame.empty() && fault.empty()) {
    TransformAnswer sensor;
    s.posed->history.transforms().at(s.queue.pose_stamp(cloud.header.stamp), frame_,
                                     options_.sensor_frame, sensor);
    if (sensor.status == TransformStatus::ok)
      scan.origin = sensor.T_target_source.translation();
    else
      fault = sensor.message;
  }
  return s.pipeline.process(scan, [&](std::int64_t stamp, RobotPose& pose) {
    if (fault.empty())
      s.lookup.at(s.posed->history, s.queue.pose_stamp(stamp), pose);
    else
      pose = {.status = FrameStatus::missing_transform, .message = fault};
  });
}

}  // namespace penumbra::io
