// SPDX-License-Identifier: Apache-2.0
#include <io/assembly/cloud_worker.hpp>

namespace penumbra::io {

void CloudWorker::follow(const std::shared_ptr<CloudSetup>& setup) {
  if (setup == setup_) return;
  setup_.reset();
  const Robot& robot = setup->posed->robot;
  pipeline_.emplace(robot, CloudConfig{.rule = options_.rule,
                                       .threads = options_.threads,
                                       .sensor_parent = setup->mount.parent,
                                       .T_parent_sensor = setup->mount.T_parent_camera});
  lookup_.emplace(robot, setup->poses);
  setup_ = setup;
}

const CloudReport& CloudWorker::label(const ReceivedCloud& cloud) {
  const CloudReport* report = nullptr;
  with_scan(cloud, [&](const Scan& scan, const PoseAt& pose_at) {
    report = &pipeline_->process(scan, pose_at);
  });
  return *report;
}

bool CloudWorker::measure(const ReceivedCloud& cloud, CloudTuner& tuner) {
  bool is_added = false;
  with_scan(cloud, [&](const Scan& scan, const PoseAt& pose_at) {
    is_added = tuner.add(*pipeline_, scan, pose_at);
  });
  return is_added;
}

void CloudWorker::with_scan(const ReceivedCloud& cloud,
                            const std::function<void(const Scan&, const PoseAt&)>& use) {
  follow(cloud.setup);
  const auto lock_poses = [this] {
    return mutex_ == nullptr ? std::unique_lock<std::mutex>() : std::unique_lock(*mutex_);
  };
  PoseHistory& history = setup_->posed->history;
  const auto pose_stamp = [this](std::int64_t stamp) { return setup_->queue.pose_stamp(stamp); };
  Scan scan{.stamp = cloud.header.stamp > 0 ? std::optional(cloud.header.stamp) : std::nullopt,
            .points = cloud.points.points,
            .times = cloud.points.times,
            .targets = cloud.targets};
  std::string fault = cloud.source_message;
  if (!options_.has_rays) {
    scan.origin.reset();
  } else if (!options_.sensor_frame.empty() && fault.empty()) {
    TransformAnswer sensor;
    const auto lock = lock_poses();
    history.transforms().at(pose_stamp(cloud.header.stamp),
                            std::string(frame_name(cloud.header.frame_id)), options_.sensor_frame,
                            sensor);
    if (sensor.status == TransformStatus::ok)
      scan.origin = sensor.T_target_source.translation();
    else
      fault = sensor.message;
  }
  use(scan, [&](std::int64_t stamp, RobotPose& pose) {
    const auto lock = lock_poses();
    if (fault.empty())
      lookup_->at(history, pose_stamp(stamp), pose);
    else
      pose = {.status = FrameStatus::missing_transform, .message = fault};
  });
}

}  // namespace penumbra::io
