// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/files/numbers.hpp>
#include <io/files/settings.hpp>
#include <io/live/cloud_text.hpp>

namespace penumbra::io {
namespace {

void set(CloudRule& rule, const std::string& name, const std::string& value) {
  bool known = false;
  for_each_setting<CloudRule>([&](const auto& setting) {
    if (name != setting.name) return;
    known = true;
    if (!set_numbers(setting.range, parse_numbers(value), rule.*setting.member))
      throw InputError(name + "=" + value + ": expected " + expected_of(setting));
  });
  if (!known)
    throw InputError(
        "there is no '" + name +
        "'; expected sensor=NAME, merged, sensor_frame=FRAME, time_offset=S, ignore_times, "
        "removed_ranges=inf, or a setting of clouds as tolerance=A,B,C");
}

}  // namespace

CloudInputOptions parse_cloud(const std::string& text) {
  std::istringstream words(text);
  CloudInputOptions cloud;
  if (!(words >> cloud.topic)) throw InputError("the topic is missing");
  try {
    std::vector<std::pair<std::string, std::string>> settings;
    for (std::string word; words >> word;) {
      const std::size_t mark = std::min(word.find('='), word.size());
      const std::string name = word.substr(0, mark);
      const std::string value = mark < word.size() ? word.substr(mark + 1) : "";
      if (name == "sensor")
        cloud.rule = CloudRule::for_sensor(value);
      else if (word == "merged")
        cloud.has_rays = false;
      else if (word == "ignore_times")
        cloud.use_times = false;
      else if (name == "time_offset" && parse_number<double>(value))
        cloud.time_offset = *parse_number<double>(value);
      else if (name == "sensor_frame" && !value.empty())
        cloud.sensor_frame = value;
      else if (word == "removed_ranges=inf")
        cloud.output.infinite_ranges = true;
      else
        settings.emplace_back(name, value);
    }
    for (const auto& [name, value] : settings) set(cloud.rule, name, value);
  } catch (const InputError& error) {
    throw InputError("'" + text + "': " + error.what());
  }
  return cloud;
}

}  // namespace penumbra::io
