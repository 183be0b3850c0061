// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "settings.hpp"

#include <future>
#include <memory>
#include <optional>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.hpp>
#include <penumbra_msgs/msg/target_views.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <std_srvs/srv/trigger.hpp>

#include <io/live/diagnostic_changes.hpp>
#include <io/live/live_fusion.hpp>
#include <io/live/live_runner.hpp>

namespace penumbra_ros {

/// Labels the depth images of cameras, and the clouds of other sensors. Configured, it has read its
/// parameters, loads the robot and follows its pose; active, it takes images and clouds.
class PenumbraNode final : public rclcpp_lifecycle::LifecycleNode {
 public:
  /// Configures and activates itself, unless the parameter `autostart` is false. Throws an
  /// exception with one line for a parameter or file that is invalid.
  explicit PenumbraNode(const rclcpp::NodeOptions& options = rclcpp::NodeOptions());
  ~PenumbraNode() override;

  /// Returns a future of the exception that ended the judging, for example of the graphics device.
  [[nodiscard]] std::shared_future<void> failure() const { return failure_; }

 private:
  CallbackReturn on_configure(const rclcpp_lifecycle::State& former) override;
  CallbackReturn on_activate(const rclcpp_lifecycle::State& former) override;
  CallbackReturn on_deactivate(const rclcpp_lifecycle::State& former) override;
  CallbackReturn on_cleanup(const rclcpp_lifecycle::State& former) override;
  CallbackReturn on_shutdown(const rclcpp_lifecycle::State& former) override;

  rcl_interfaces::msg::SetParametersResult change(const Changes& changes);
  void make_outputs();
  void clean_up();
  void check();
  void warn_of_unknown_parameters();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status, std::size_t number);

  [[nodiscard]] bool wants_overlay() const;
  void fuse();
  void add_diagnostics();

  Settings settings_;
  std::vector<std::string> subjects_;  // of the diagnostics
  // While configured:
  rclcpp::Node::SharedPtr images_;
  std::vector<std::unique_ptr<Outputs>> outputs_;      // of each camera
  std::vector<std::unique_ptr<CloudOutputs>> clouds_;  // of each sensor of clouds
  rclcpp::Publisher<penumbra_msgs::msg::TargetViews>::SharedPtr
      target_views_;                                // of several cameras
  std::optional<penumbra::io::LiveFusion> fusion_;  // likewise
  std::unique_ptr<penumbra::io::LiveRunner> runner_;
  std::vector<std::unique_ptr<CalibrationServices>> calibrations_;  // of each camera
  std::unique_ptr<Inputs> inputs_;
  std::optional<penumbra::io::LiveDiagnostics> diagnostics_;
  penumbra::io::DiagnosticArrayMessage statuses_;  // of the last check
  penumbra::io::DiagnosticChanges changes_;
  rclcpp::TimerBase::SharedPtr timer_;
  rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr reset_;

  bool active_ = false;
  std::promise<void> failed_;
  std::shared_future<void> failure_ = failed_.get_future();
  diagnostic_updater::Updater updater_;
  OnSetParametersCallbackHandle::SharedPtr on_change_;
  rclcpp::PreShutdownCallbackHandle before_shutdown_;
};

}  // namespace penumbra_ros
