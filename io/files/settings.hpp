// SPDX-License-Identifier: Apache-2.0
// Settings (penumbra/base/setting.hpp) in files, options and parameters. There a value is one or
// several numbers.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <penumbra/base/setting.hpp>
#include <penumbra/labels/labels.hpp>

#include <io/files/yaml.hpp>

namespace penumbra::io {

/// Sets a value if the numbers are one of its possible values; else returns false.
template <typename Value>
[[nodiscard]] bool set_numbers(const SettingRange& range, std::span<const double> n, Value& to) {
  if constexpr (NumberSetting<Value>) {
    if (n.size() != 1 || !is_in(range, n[0])) return false;
    to = static_cast<Value>(n[0]);
    return static_cast<double>(to) == n[0];
  } else {
    if (n.size() != 3) return false;
    to = {n[0], n[1], n[2]};
    if constexpr (requires { to.is_valid(); }) return to.is_valid();
    return true;
  }
}

/// Reads a value. Returns false for a value that is not possible.
template <typename Value>
[[nodiscard]] bool read_value(const YamlNode& node, const SettingRange& range, Value& to) {
  if constexpr (std::is_same_v<Value, bool>) {
    to = node.boolean();
    return true;
  } else if constexpr (requires { to.has_value(); }) {
    return read_value(node, range, to.emplace());
  } else if constexpr (std::is_enum_v<Value>) {
    int i = static_cast<int>(range.least);
    while (is_in(range, i) && to_string(static_cast<Value>(i)) != node.text()) ++i;
    to = static_cast<Value>(i);
    return is_in(range, i);
  } else {
    return set_numbers(range, node.is_list() ? node.numbers() : std::vector{node.number()}, to);
  }
}

/// Reads the settings that a map gives and returns their names. Throws InputError with file, line
/// and key, also for a key that is neither a setting nor one of `others`.
template <typename Struct>
std::set<std::string_view> read_settings(const YamlNode& node, Struct& to,
                                         std::vector<std::string_view> others = {}) {
  std::set<std::string_view> given;
  for_each_setting<Struct>([&](const auto& setting) {
    others.push_back(setting.name);
    const YamlNode* const value = node.find(setting.name);
    if (value == nullptr) return;
    given.insert(setting.name);
    if (!read_value(*value, setting.range, to.*setting.member))
      value->fail((value->is_list() ? "" : "is " + value->text() + "; ") + "expected " +
                  expected_of(setting));
  });
  node.allow_only(others);
  return given;
}

/// Settings of the label rule in place of others'.
struct RuleOptions {
  LabelRule values = {};
  std::set<std::string_view> given = {};   ///< names of the settings that `values` has
  std::optional<std::string> sensor = {};  ///< of LabelRule::for_sensor
  bool paper_labels = false;

  /// Returns false for a number outside the setting's range.
  template <typename Value>
  [[nodiscard]] bool give(const Setting<LabelRule, Value>& setting,
                          std::span<const double> numbers) {
    given.insert(setting.name);
    return set_numbers(setting.range, numbers, values.*setting.member);
  }

  /// Returns `recorded` with these choices.
  [[nodiscard]] LabelRule applied_to(const LabelRule& recorded) const {
    LabelRule rule = paper_labels ? LabelRule::paper() : recorded;
    if (sensor) {
      const LabelRule of_sensor = LabelRule::for_sensor(*sensor);
      rule.tolerance = of_sensor.tolerance;
      rule.fringe_reach = of_sensor.fringe_reach;
    }
    for_each_setting<LabelRule>([&](const auto& setting) {
      if (given.contains(setting.name)) rule.*setting.member = values.*setting.member;
    });
    return rule;
  }
};

}  // namespace penumbra::io
