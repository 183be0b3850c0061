// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <penumbra_msgs/srv/calibrate.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <std_srvs/srv/trigger.hpp>

#include <io/live/live_runner.hpp>

namespace penumbra_ros {

/// The services "calibrate" and "apply_calibration" of a camera.
class CalibrationServices {
 public:
  /// `below`: of their names, "~/" or "~/CAMERA/". `runner` must outlive this.
  CalibrationServices(rclcpp_lifecycle::LifecycleNode& node, const std::string& below,
                      penumbra::io::LiveRunner& runner, std::size_t camera);

 private:
  using Calibrate = penumbra_msgs::srv::Calibrate;
  using Trigger = std_srvs::srv::Trigger;
  void calibrate(const Calibrate::Request& request, Calibrate::Response& response);
  void apply(Trigger::Response& response);
  [[nodiscard]] std::string command() const;

  penumbra::io::LiveRunner& runner_;
  std::size_t camera_;
  rclcpp::Service<Calibrate>::SharedPtr calibrate_;
  rclcpp::Service<Trigger>::SharedPtr apply_;
};

}  // namespace penumbra_ros
