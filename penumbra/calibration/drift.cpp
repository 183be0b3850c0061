// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>

#include <penumbra/calibration/problem.hpp>
#include <penumbra/calibration/watch.hpp>

namespace penumbra {

std::string calibration::of_scans(std::string message) {
  // What no option of clouds mends, and words of images. Up to `until`; empty: `from` alone.
  static constexpr std::array<std::array<std::string_view, 3>, 8> words{
      {{" (penumbra ", ")", ""},
       {": run 'penumbra ", "'", ""},
       {" on this input", "", ""},
       {"the overlay of frame", "", "scan"},
       {", camera_info and the camera's pose (of the optical", "",
        " and the sensor's pose (of the points'"},
       {"depth image", "", "scan"},
       {"image", "", "scan"},
       {"camera", "", "sensor"}}};
  for (const auto& [from, until, to] : words)
    for (std::size_t at = message.find(from); at < message.size(); at = message.find(from, at)) {
      const std::size_t end = message.find(until, at + from.size()) + until.size();
      message.replace(at, end - at, to);
      at += to.size();
    }
  return message;
}

double Drift::rotation() const {
  return std::abs(Eigen::AngleAxisd(T_calibrated_camera.linear()).angle());
}
double Drift::position_error() const {
  return calibration::longest_axis(covariance.bottomRightCorner<3, 3>());
}
double Drift::rotation_error() const {
  return calibration::longest_axis(covariance.topLeftCorner<3, 3>());
}

std::string Drift::message() const {
  constexpr double degrees = 180.0 / std::numbers::pi;
  constexpr double much = 0.4;
  std::array<char, 256> text{};
  if (seen_through > much) {
    std::snprintf(
        text.data(), text.size(),
        "the sensor sees past %.0f %% of the robot: the camera is elsewhere than calibrated, "
        "or the joints are another robot's: run 'penumbra calibrate'",
        100.0 * seen_through);
    return is_camera ? text.data() : calibration::of_scans(text.data());
  }
  std::snprintf(text.data(), text.size(), "images and joint states are about %.0f +- %.0f ms apart",
                1e3 * std::abs(time_offset.value), std::max(1.0, 2e3 * time_offset.sigma));
  const std::string apart = text.data();
  std::string line;
  if (clocks_differ) {
    std::snprintf(text.data(), text.size(), ": set time_offset to %.3f", time_offset.value);
    line = apart + text.data();
  }
  if (has_moved || camera_or_clocks) {
    std::string by;
    const auto add = [&](const char* format, double value, double error) {
      if (error > value) return;
      std::snprintf(text.data(), text.size(), format, value, error);
      by += (by.empty() ? "" : " and ") + std::string(text.data());
    };
    add("%.1f +- %.1f mm", 1e3 * position(), 1e3 * position_error());
    add("%.2f +- %.2f degrees", degrees * rotation(), degrees * rotation_error());
    line += by.empty() ? "the camera has moved since its calibration, how far is not known yet"
                       : "the camera is " + by + " from its calibration";
    if (has_moved && bumped_at)
      line += ", bumped at frame " + std::to_string(*bumped_at) + " +- " +
              std::to_string(bumped_within);
    if (camera_or_clocks)
      line += ", or " + apart + ", or both: move the robot at other speeds to tell them apart";
    else
      line += ": run 'penumbra calibrate'";
  }
  return is_camera ? line : calibration::of_scans(std::move(line));
}

}  // namespace penumbra
