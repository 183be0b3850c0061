// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <rclcpp_lifecycle/lifecycle_node.hpp>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/live/live_inbox.hpp>

namespace penumbra_ros {

/// The node's parameters.
struct Settings {
  penumbra::io::LiveOptions live;
  std::vector<std::string> cloud_topics;  ///< of the results of live.clouds
  penumbra::PipelineConfig pipeline;
  std::set<std::string> publish;  ///< names of results
  bool target_frames = false;     ///< publishes targets in TF
  bool autostart = true;          ///< the node configures and activates itself
  /// Names of all, and whether they can change while the node is configured.
  std::map<std::string, bool> parameters;
};

/// Reads the parameters; declares those that are not declared. Throws an exception whose message
/// names the parameter.
[[nodiscard]] Settings read_settings(rclcpp_lifecycle::LifecycleNode& node);

/// Return these parameters with the values of `changes`, or the node's for those that are not in
/// it. Throw penumbra::InputError for invalid values.
using Changes = std::vector<rclcpp::Parameter>;
[[nodiscard]] penumbra::LabelRule read_rule(const rclcpp_lifecycle::LifecycleNode& node,
                                            const Changes& changes = {});
[[nodiscard]] std::set<std::string> read_publish(const rclcpp_lifecycle::LifecycleNode& node,
                                                 const Changes& changes = {});

}  // namespace penumbra_ros
