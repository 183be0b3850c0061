// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <moveit_msgs/srv/get_planning_scene.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>

#include <io/live/live_diagnostics.hpp>
#include <io/live/live_runner.hpp>
#include <io/live/scene_question.hpp>

namespace penumbra_ros {

/// Hands received messages to a runner. Use it from the node's default callback group.
class Inputs {
 public:
  /// Both must outlive this.
  Inputs(rclcpp_lifecycle::LifecycleNode& node, penumbra::io::LiveRunner& runner);

  /// Subscribes to what is needed now: target topics once their type is known, colour images if
  /// `with_color`, depth images and clouds if `enabled`. Reliable where all publishers offer that:
  /// of large images most are lost otherwise. Asks MoveIt for its planning scene (SceneQuestion).
  void follow(bool with_color, bool enabled);
  /// Returns whether MoveIt has not said yet what is attached.
  [[nodiscard]] bool waits_for_scene() const;

  /// Returns the state of each of the runner's topics.
  [[nodiscard]] std::vector<penumbra::io::LiveLink> links() const;

 private:
  struct Link {
    penumbra::io::InputTopic topic;
    rclcpp::SubscriptionBase::SharedPtr subscription;  // null: not subscribed to
    bool is_reliable = false;                          // all of its publishers are
    bool has_publisher = false;
    rclcpp::Client<moveit_msgs::srv::GetPlanningScene>::SharedPtr scene;  // of planning scenes
    penumbra::io::SceneQuestion question;                                 // likewise
    penumbra::io::LiveLink state;
  };

  void find_publishers(std::size_t topic);
  void ask_for_scene(std::size_t topic);
  [[nodiscard]] bool takes(std::size_t topic) const;
  [[nodiscard]] rclcpp::SubscriptionBase::SharedPtr subscribe(std::size_t topic);
  template <typename M>
  rclcpp::SubscriptionBase::SharedPtr subscribe_latched(std::size_t topic);
  template <typename M>
  [[nodiscard]] rclcpp::SubscriptionBase::SharedPtr subscribe_serialised(std::size_t topic);
  [[nodiscard]] rclcpp::SubscriptionBase::SharedPtr subscribe_images(std::size_t topic);
  [[nodiscard]] rclcpp::SubscriptionBase::SharedPtr subscribe_generic(std::size_t topic);
  [[nodiscard]] rclcpp::SubscriptionOptions options_of(std::size_t topic);
  [[nodiscard]] rclcpp::QoS qos_of(std::size_t topic) const;

  rclcpp_lifecycle::LifecycleNode& node_;
  penumbra::io::LiveRunner& runner_;
  std::vector<Link> links_;  // of each topic
};

}  // namespace penumbra_ros
