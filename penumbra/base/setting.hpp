// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>
#include <tuple>
#include <type_traits>

#include <penumbra/base/error.hpp>

namespace penumbra {

/// The numbers that a setting may have, or the enumerators. Both ends are included.
struct SettingRange {
  double least = 0, most = 0;
};

/// The description of a member of a settings struct. The struct lists them in settings(). Its
/// check(), files, options, ROS parameters, Python's arguments, reports and the docs' tables are
/// made from that list.
template <typename Struct, typename Value>
struct Setting {
  constexpr Setting(const char* name_, Value Struct::*member_, SettingRange range_,
                    const char* unit_, const char* meaning_)
      : name(name_), member(member_), range(range_), unit(unit_), meaning(meaning_) {}

  const char* name;
  Value Struct::*member;
  SettingRange range;
  const char* unit;     ///< empty: none
  const char* meaning;  ///< a phrase without capital and full stop
};

/// Calls visit(setting) for each setting of a struct.
template <typename Struct, typename Visit>
void for_each_setting(const Visit& visit) {
  std::apply([&](const auto&... setting) { (visit(setting), ...); }, Struct::settings());
}

template <typename Value>
concept NumberSetting = std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>;

[[nodiscard]] inline bool is_in(const SettingRange& range, double value) {
  return value >= range.least && value <= range.most;
}

/// Returns a setting's possible values: "a whole number from 0 to 63", "one of visible, partial".
template <typename Value>
[[nodiscard]] std::string expected_of(const auto& setting) {
  const auto [least, most] = setting.range;
  std::ostringstream text;
  if constexpr (requires(Value value) { value.has_value(); })
    return expected_of<typename Value::value_type>(setting);
  else if constexpr (std::is_enum_v<Value>)
    for (int i = static_cast<int>(least); i <= static_cast<int>(most); ++i)
      text << (text.tellp() > 0 ? ", " : "one of ") << to_string(static_cast<Value>(i));
  else if constexpr (NumberSetting<Value>)
    text << (std::is_integral_v<Value> ? "a whole number" : "a number") << " from " << least
         << " to " << most;
  else
    text << "three numbers, " << setting.meaning;
  return text.str();
}
template <typename Struct, typename Value>
[[nodiscard]] std::string expected_of(const Setting<Struct, Value>& setting) {
  return expected_of<Value>(setting);
}

/// Throws InputError for a number or an enumerator out of its range.
template <typename Value>
void check_value(const auto& setting, const Value& value) {
  if constexpr (requires { value.has_value(); }) {
    if (value) check_value(setting, *value);
  } else if constexpr (NumberSetting<Value> || std::is_enum_v<Value>) {
    if (is_in(setting.range, static_cast<double>(value))) return;
    std::ostringstream text;
    if constexpr (std::is_enum_v<Value>)
      text << setting.name << ' ' << to_string(value);
    else
      text << setting.name << ' ' << value;
    throw InputError(text.str() + ": expected " + expected_of<Value>(setting));
  }
}

/// Throws InputError, with name, value and range, for a setting that is out of its range.
template <typename Struct>
void check_settings(const Struct& values) {
  for_each_setting<Struct>(
      [&](const auto& setting) { check_value(setting, values.*setting.member); });
}

}  // namespace penumbra
