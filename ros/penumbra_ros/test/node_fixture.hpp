// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "penumbra_node.hpp"
#include "player.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rclcpp/rclcpp.hpp>

namespace penumbra_ros::test {

using namespace std::chrono_literals;

inline const std::string example = PENUMBRA_EXAMPLE;

using Parameters = std::vector<rclcpp::Parameter>;

inline rclcpp::NodeOptions options(const Parameters& more = {}) {
  std::vector<rclcpp::Parameter> parameters{
      {"packages", std::vector<std::string>{"arm_description=" + example + "/arm_description"}}};
  parameters.insert(parameters.end(), more.begin(), more.end());
  return rclcpp::NodeOptions().parameter_overrides(parameters).use_intra_process_comms(true);
}

/// A test fails only if an event does not come at all.
inline constexpr std::chrono::seconds patience(300);

class NodeTest : public testing::Test {
 protected:
  NodeTest() {
    rclcpp::init(0, nullptr);
    executor_ = std::make_unique<rclcpp::executors::SingleThreadedExecutor>();
  }
  ~NodeTest() override {
    executor_.reset();
    rclcpp::shutdown();
  }

  /// Spins until `done`. Returns whether it is.
  template <typename F>
  bool spin_until(const F& done, std::chrono::seconds at_most = patience) {
    const auto end = std::chrono::steady_clock::now() + at_most;
    while (!done() && std::chrono::steady_clock::now() < end) executor_->spin_once(10ms);
    return done();
  }

  /// Starts a node and a player, and plays frames until the first labels arrive.
  void start(const std::vector<rclcpp::Parameter>& parameters = {}) {
    player_ = std::make_unique<Player>(example, true);
    node_ = std::make_shared<PenumbraNode>(options(parameters));
    executor_->add_node(player_->node);
    executor_->add_node(node_->get_node_base_interface());
    labels_ = player_->node->create_subscription<Image>(
        "/penumbra/labels", 10,
        [this](Image::ConstSharedPtr image) { received_[stamp_of(image->header)] = image; });
    ASSERT_TRUE(
        spin_until([&] { return player_->is_heard() && labels_->get_publisher_count() > 0; }));
    ASSERT_TRUE(spin_until([&] {
      later_ += 1'000'000'000;
      player_->play(0, later_);
      return spin_until([&] { return !received_.empty(); }, 1s);
    })) << "no labels";
  }

  /// Plays a frame, again if need be, and returns its labels; null if they do not come in time.
  Image::ConstSharedPtr labels_of(std::size_t index, std::chrono::seconds at_most = patience) {
    const std::int64_t recorded = *player_->reader.read(index, false).stamp;
    spin_until(
        [&] {
          later_ += 1'000'000'000;
          player_->play(index, later_);
          return spin_until([&] { return received_.count(recorded + later_) > 0; }, 5s);
        },
        at_most);
    const auto received = received_.find(recorded + later_);
    return received == received_.end() ? nullptr : received->second;
  }

  static std::int64_t stamp_of(const std_msgs::msg::Header& header) {
    return rclcpp::Time(header.stamp).nanoseconds();
  }

  template <typename S>
  typename S::Response::SharedPtr call(const std::string& name,
                                       const typename S::Request::SharedPtr& request) {
    auto client = player_->node->create_client<S>("/penumbra/" + name);
    if (!spin_until([&] { return client->service_is_ready(); })) return nullptr;
    auto answer = client->async_send_request(request);
    if (!spin_until([&] { return answer.wait_for(0s) == std::future_status::ready; }))
      return nullptr;
    return answer.get();
  }

  std::unique_ptr<rclcpp::executors::SingleThreadedExecutor> executor_;
  std::unique_ptr<Player> player_;
  std::shared_ptr<PenumbraNode> node_;
  rclcpp::Subscription<Image>::SharedPtr labels_;
  std::map<std::int64_t, Image::ConstSharedPtr> received_;  // by stamp
  std::int64_t later_ = 0;
};

}  // namespace penumbra_ros::test
