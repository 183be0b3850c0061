// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <penumbra_msgs/srv/look_ahead.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>

#include <io/assembly/assembled_frame.hpp>

namespace penumbra_ros {

/// The service "look_ahead" of a camera: what motions would hide of the newest targets. It is
/// answered on a thread of its own, one request after the other, so that no message waits.
class LookAheadService {
 public:
  /// `name`: "~/look_ahead".
  LookAheadService(rclcpp_lifecycle::LifecycleNode& node, const std::string& name);

  /// Takes the newest judged image.
  void take(const penumbra::io::AssembledFrame& job);
  /// The rule of the images from now on.
  void set_rule(const penumbra::LabelRule& rule);

 private:
  using Service = penumbra_msgs::srv::LookAhead;
  /// The robot and the camera, the newest image with targets, and where the robot is now.
  struct Seen {
    std::shared_ptr<penumbra::io::SensorSetup> setup;
    penumbra::RobotPose pose;
    std::vector<penumbra::Target> targets;
    std::chrono::steady_clock::time_point at = {};  // when the targets came
    std::vector<double> positions;
    penumbra::LabelRule rule;
  };
  static Service::Response answer(const Service::Request& request, const Seen& seen);

  std::mutex mutex_;
  Seen newest_;  // guarded by mutex_; without a setup: none yet
  rclcpp::Service<Service>::SharedPtr service_;
  std::future<void> answering_;
};

}  // namespace penumbra_ros
