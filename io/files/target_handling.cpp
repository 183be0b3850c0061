// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>
#include <vector>

#include <io/files/settings.hpp>
#include <io/files/target_shapes.hpp>

namespace penumbra::io {
namespace {

/// Returns settings that a motion does not use.
std::vector<std::string_view> unused_by(const PoseTrackerConfig& config) {
  switch (config.motion) {
    case Motion::constant_twist:
      return {"drift", "angular_drift"};
    case Motion::constant_velocity:
      return {"drift", "angular_acceleration", "angular_speed_sigma"};
    case Motion::along_direction:
      if (!config.speed) return {"angular_acceleration", "angular_speed_sigma"};
      [[fallthrough]];
    case Motion::still:
      return {"acceleration", "speed_sigma", "angular_acceleration", "angular_speed_sigma"};
  }
  return {};
}

std::vector<std::string_view> unused_by(const PointTrackerConfig& config) {
  if (config.motion == PointMotion::hold) return {"acceleration", "speed_sigma"};
  return {"held_speed"};
}

template <typename Config>
Config read_config(const YamlNode& node, Config config) {
  read_settings(node, config);
  node.with_context([&] { config.check(); });
  return config;
}

template <typename Config>
Config read_tracker(const YamlNode& node) {
  const Config config = read_config(node, Config());
  for (const std::string_view key : unused_by(config))
    if (const YamlNode* value = node.find(key))
      value->fail("is given; motion " + std::string(to_string(config.motion)) +
                  ", as it is set here, does not use it");
  return config;
}

}  // namespace

TargetThresholds read_thresholds(const YamlNode& node, TargetThresholds thresholds) {
  return read_config(node, thresholds);
}

TargetHandling read_handling(const YamlNode& node) {
  if (node.is_map()) {
    node.allow_only({"pose", "point"});
    if (node.entries().size() != 1) node.fail("expected one of pose and point");
    const YamlNode& chosen = node.entries().front();
    if (chosen.key() == "pose") return read_tracker<PoseTrackerConfig>(chosen);
    return read_tracker<PointTrackerConfig>(chosen);
  }
  if (node.text() == "none") return std::monostate();
  if (node.text() == "pose") return PoseTrackerConfig();
  if (node.text() == "point") return PointTrackerConfig();
  node.fail("is '" + node.text() + "'; expected none, pose or point, or one of the latter with " +
            "its settings");
}

}  // namespace penumbra::io
