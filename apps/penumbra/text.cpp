// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <iostream>
#include <utility>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/text.hpp>

namespace penumbra::app {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    parts.emplace_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

std::string fixed(double value, int digits) {
  char buffer[400];  // the largest double has 309 digits before the point
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value,
                                    std::chars_format::fixed, std::min(digits, 20));
  return {buffer, result.ptr};
}

Pipeline make_pipeline(Robot robot, const Camera& camera, const PipelineConfig& config,
                       const std::filesystem::path& camera_info) {
  try {
    return {std::move(robot), camera, config};
  } catch (const LensError& error) {
    throw InputError(camera_info.string() + ": " + error.what());
  }
}

void tell_notes(const Robot& robot) {
  for (const std::string& note : robot.notes()) std::cerr << "penumbra: note: " << note << '\n';
}

}  // namespace penumbra::app
