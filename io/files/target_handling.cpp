// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/target_shapes.hpp>

namespace penumbra::io {
namespace {

void read_number(const YamlNode& node, std::string_view key, double& to) {
  if (const YamlNode* value = node.find(key)) to = value->number();
}

void read_count(const YamlNode& node, std::string_view key, std::size_t& to) {
  const YamlNode* value = node.find(key);
  if (value == nullptr) return;
  const std::int64_t count = value->integer();
  if (count < 0) value->fail("is " + value->text() + "; a number from 0 is wanted");
  to = static_cast<std::size_t>(count);
}

void read_flag(const YamlNode& node, std::string_view key, bool& to) {
  if (const YamlNode* value = node.find(key)) to = value->boolean();
}

template <typename T, std::size_t count>
void read_choice(const YamlNode& node, std::string_view key,
                 const std::array<std::pair<std::string_view, T>, count>& choices, T& to) {
  const YamlNode* value = node.find(key);
  if (value == nullptr) return;
  std::string known;
  for (const auto& [name, choice] : choices) {
    if (value->text() == name) {
      to = choice;
      return;
    }
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  value->fail("is '" + value->text() + "'; one of " + known + " is wanted");
}

constexpr std::array<std::pair<std::string_view, Verdict>, 3> verdicts{
    {{"visible", Verdict::visible}, {"partial", Verdict::partial}, {"hidden", Verdict::hidden}}};
constexpr std::array<std::pair<std::string_view, Motion>, 4> motions{
    {{"constant_twist", Motion::constant_twist},
     {"constant_velocity", Motion::constant_velocity},
     {"along_direction", Motion::along_direction},
     {"still", Motion::still}}};
constexpr std::array<std::pair<std::string_view, PointMotion>, 2> point_motions{
    {{"hold", PointMotion::hold}, {"constant_velocity", PointMotion::constant_velocity}}};

/// What both trackers have.
template <typename Config>
void read_track(const YamlNode& node, Config& config) {
  read_number(node, "acceleration", config.acceleration);
  read_number(node, "timeout", config.timeout);
  read_number(node, "gate", config.gate);
  read_count(node, "gate_patience", config.gate_patience);
  read_number(node, "memory", config.memory);
  read_count(node, "max_estimates", config.max_estimates);
  read_number(node, "speed_sigma", config.speed_sigma);
  if (node.find("worst") == nullptr) return;
  Verdict worst{};
  read_choice(node, "worst", verdicts, worst);
  config.worst = worst;
}

/// Settings that a motion does not use would be without effect.
void refuse_unused(const YamlNode& node, std::string_view motion,
                   std::initializer_list<std::string_view> unused) {
  for (const std::string_view key : unused)
    if (const YamlNode* value = node.find(key))
      value->fail("is given; motion " + std::string(motion) + " does not use it");
}

void refuse_unused(const YamlNode& node, const PoseTrackerConfig& config) {
  switch (config.motion) {
    case Motion::constant_twist:
      return refuse_unused(node, "constant_twist", {"drift", "angular_drift"});
    case Motion::constant_velocity:
      return refuse_unused(node, "constant_velocity",
                           {"drift", "angular_acceleration", "angular_speed_sigma"});
    case Motion::along_direction:
      if (config.speed)
        refuse_unused(node, "along_direction with a known speed", {"acceleration", "speed_sigma"});
      return refuse_unused(node, "along_direction",
                           {"angular_acceleration", "angular_speed_sigma"});
    case Motion::still:
      return refuse_unused(
          node, "still",
          {"acceleration", "speed_sigma", "angular_acceleration", "angular_speed_sigma"});
  }
}

void refuse_unused(const YamlNode& node, const PointTrackerConfig& config) {
  if (config.motion == PointMotion::hold)
    refuse_unused(node, "hold", {"acceleration", "speed_sigma"});
  else
    refuse_unused(node, "constant_velocity", {"held_speed"});
}

PoseTrackerConfig read_pose(const YamlNode& node) {
  node.allow_only({"motion", "direction", "speed", "position_sigma", "orientation_sigma",
                   "acceleration", "angular_acceleration", "drift", "angular_drift", "speed_sigma",
                   "angular_speed_sigma", "timeout", "gate", "gate_patience", "memory",
                   "max_estimates", "worst"});
  PoseTrackerConfig config;
  read_choice(node, "motion", motions, config.motion);
  if (const YamlNode* direction = node.find("direction"))
    config.direction = Eigen::Vector3d(direction->numbers(3).data());
  if (const YamlNode* speed = node.find("speed")) config.speed = speed->number();
  read_number(node, "position_sigma", config.position_sigma);
  read_number(node, "orientation_sigma", config.orientation_sigma);
  read_number(node, "angular_acceleration", config.angular_acceleration);
  read_number(node, "drift", config.drift);
  read_number(node, "angular_drift", config.angular_drift);
  read_number(node, "angular_speed_sigma", config.angular_speed_sigma);
  read_track(node, config);
  node.blamed_for([&] { config.check(); });
  refuse_unused(node, config);
  return config;
}

PointTrackerConfig read_point(const YamlNode& node) {
  node.allow_only({"motion", "sigma", "acceleration", "speed_sigma", "held_speed", "timeout",
                   "gate", "gate_patience", "memory", "max_estimates", "worst"});
  PointTrackerConfig config;
  read_choice(node, "motion", point_motions, config.motion);
  read_number(node, "sigma", config.sigma);
  read_number(node, "held_speed", config.held_speed);
  read_track(node, config);
  node.blamed_for([&] { config.check(); });
  refuse_unused(node, config);
  return config;
}

}  // namespace

TargetThresholds read_thresholds(const YamlNode& node, TargetThresholds thresholds) {
  node.allow_only({"partial_enter", "partial_leave", "hidden_enter", "hidden_leave",
                   "unknown_limit", "past_limit", "min_measured", "min_inside", "beyond_hides",
                   "others_hide", "point_min_pixels", "point_min_fraction"});
  read_number(node, "partial_enter", thresholds.partial_enter);
  read_number(node, "partial_leave", thresholds.partial_leave);
  read_number(node, "hidden_enter", thresholds.hidden_enter);
  read_number(node, "hidden_leave", thresholds.hidden_leave);
  if (const YamlNode* limit = node.find("unknown_limit"))
    thresholds.unknown_limit = limit->number();
  read_number(node, "past_limit", thresholds.past_limit);
  read_number(node, "min_measured", thresholds.min_measured);
  read_number(node, "min_inside", thresholds.min_inside);
  read_flag(node, "beyond_hides", thresholds.beyond_hides);
  read_flag(node, "others_hide", thresholds.others_hide);
  read_count(node, "point_min_pixels", thresholds.point_min_pixels);
  read_number(node, "point_min_fraction", thresholds.point_min_fraction);
  node.blamed_for([&] { thresholds.check(); });
  return thresholds;
}

TargetHandling read_handling(const YamlNode& node) {
  if (node.is_map()) {
    node.allow_only({"pose", "point"});
    if (node.entries().size() != 1) node.fail("one of pose and point is wanted");
    const YamlNode& chosen = node.entries().front();
    if (chosen.key() == "pose") return read_pose(chosen);
    return read_point(chosen);
  }
  if (node.text() == "none") return std::monostate();
  if (node.text() == "pose") return PoseTrackerConfig();
  if (node.text() == "point") return PointTrackerConfig();
  node.fail("is '" + node.text() + "'; none, pose or point is wanted, or one of the latter with " +
            "its settings");
}

}  // namespace penumbra::io
