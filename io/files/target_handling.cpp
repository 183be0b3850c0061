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

void read(const YamlNode& value, double& to) { to = value.number(); }
void read(const YamlNode& value, std::optional<double>& to) { to = value.number(); }
void read(const YamlNode& value, bool& to) { to = value.boolean(); }
void read(const YamlNode& value, std::size_t& to) {
  const std::int64_t count = value.integer();
  if (count < 0) value.fail("is " + value.text() + "; a number from 0 is wanted");
  to = static_cast<std::size_t>(count);
}

/// A key and the member that it sets.
template <typename Config>
struct Setting {
  std::string_view key;
  std::variant<double Config::*, std::optional<double> Config::*, std::size_t Config::*,
               bool Config::*>
      member;
};

/// Reads all settings that are given. Throws for keys that are neither settings nor `others`.
template <typename Config>
void read_settings(const YamlNode& node, const std::vector<Setting<Config>>& settings,
                   std::vector<std::string_view> others, Config& config) {
  for (const Setting<Config>& setting : settings) {
    others.push_back(setting.key);
    if (const YamlNode* value = node.find(setting.key))
      std::visit([&](auto member) { read(*value, config.*member); }, setting.member);
  }
  node.allow_only(others);
}

template <typename T, std::size_t count, typename To>
void read_choice(const YamlNode& node, std::string_view key,
                 const std::array<std::pair<std::string_view, T>, count>& choices, To& to) {
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

/// Refuses settings that a motion does not use.
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
  using C = PoseTrackerConfig;
  C config;
  read_settings<C>(node,
                   {{"speed", &C::speed},
                    {"position_sigma", &C::position_sigma},
                    {"orientation_sigma", &C::orientation_sigma},
                    {"acceleration", &C::acceleration},
                    {"angular_acceleration", &C::angular_acceleration},
                    {"drift", &C::drift},
                    {"angular_drift", &C::angular_drift},
                    {"speed_sigma", &C::speed_sigma},
                    {"angular_speed_sigma", &C::angular_speed_sigma},
                    {"timeout", &C::timeout},
                    {"gate", &C::gate},
                    {"gate_patience", &C::gate_patience},
                    {"memory", &C::memory},
                    {"max_estimates", &C::max_estimates}},
                   {"motion", "direction", "worst"}, config);
  read_choice(node, "motion", motions, config.motion);
  if (const YamlNode* direction = node.find("direction"))
    config.direction = Eigen::Vector3d(direction->numbers(3).data());
  read_choice(node, "worst", verdicts, config.worst);
  node.blamed_for([&] { config.check(); });
  refuse_unused(node, config);
  return config;
}

PointTrackerConfig read_point(const YamlNode& node) {
  using C = PointTrackerConfig;
  C config;
  read_settings<C>(node,
                   {{"sigma", &C::sigma},
                    {"acceleration", &C::acceleration},
                    {"speed_sigma", &C::speed_sigma},
                    {"held_speed", &C::held_speed},
                    {"timeout", &C::timeout},
                    {"gate", &C::gate},
                    {"gate_patience", &C::gate_patience},
                    {"memory", &C::memory},
                    {"max_estimates", &C::max_estimates}},
                   {"motion", "worst"}, config);
  read_choice(node, "motion", point_motions, config.motion);
  read_choice(node, "worst", verdicts, config.worst);
  node.blamed_for([&] { config.check(); });
  refuse_unused(node, config);
  return config;
}

}  // namespace

TargetThresholds read_thresholds(const YamlNode& node, TargetThresholds thresholds) {
  using T = TargetThresholds;
  read_settings<T>(node,
                   {{"partial_enter", &T::partial_enter},
                    {"partial_leave", &T::partial_leave},
                    {"hidden_enter", &T::hidden_enter},
                    {"hidden_leave", &T::hidden_leave},
                    {"unknown_limit", &T::unknown_limit},
                    {"past_limit", &T::past_limit},
                    {"min_measured", &T::min_measured},
                    {"min_inside", &T::min_inside},
                    {"beyond_hides", &T::beyond_hides},
                    {"others_hide", &T::others_hide},
                    {"point_min_pixels", &T::point_min_pixels},
                    {"point_min_fraction", &T::point_min_fraction}},
                   {}, thresholds);
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
