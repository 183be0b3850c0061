// SPDX-License-Identifier: Apache-2.0
#include "penumbra_node.hpp"

#include <cstdio>
#include <exception>
#include <memory>

#include <rclcpp/rclcpp.hpp>

#include <penumbra/base/error.hpp>

namespace {

/// Exit status as of the command line.
constexpr int users_fault = 2, our_fault = 1;

int fail(const std::exception& error, int status) {
  std::fprintf(stderr, "penumbra_node: %s\n", error.what());
  rclcpp::shutdown();
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  std::shared_ptr<penumbra_ros::PenumbraNode> node;
  try {
    const auto others = rclcpp::init_and_remove_ros_arguments(argc, argv);
    if (others.size() > 1)
      throw penumbra::InputError("unknown argument '" + others[1] +
                                 "'; parameters are given as --ros-args -p NAME:=VALUE");
    node = std::make_shared<penumbra_ros::PenumbraNode>();
  } catch (const std::exception& error) {
    return fail(error, users_fault);
  }
  try {
    rclcpp::executors::SingleThreadedExecutor executor;
    executor.add_node(node->get_node_base_interface());
    const auto failure = node->failure();
    if (executor.spin_until_future_complete(failure) == rclcpp::FutureReturnCode::SUCCESS)
      failure.get();
  } catch (const std::exception& error) {
    return fail(error, our_fault);
  }
  rclcpp::shutdown();
  return 0;
}
