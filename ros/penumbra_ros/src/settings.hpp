// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include <rclcpp/rclcpp.hpp>

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
};

/// Declares the parameters and reads them. Throws an exception whose message names the parameter.
[[nodiscard]] Settings declare_settings(rclcpp::Node& node);

/// Return these parameters with the values of `changes`, or the node's for those that are not in
/// it. Throw penumbra::InputError for invalid values.
using Changes = std::vector<rclcpp::Parameter>;
[[nodiscard]] penumbra::LabelRule read_rule(const rclcpp::Node& node, const Changes& changes = {});
[[nodiscard]] std::set<std::string> read_publish(const rclcpp::Node& node,
                                                 const Changes& changes = {});

}  // namespace penumbra_ros
