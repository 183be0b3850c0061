// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include <penumbra/base/text.hpp>
#include <penumbra/calibration/problem.hpp>

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

std::string calibration::amount_of(const Drift& drift, int digits) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  std::string text;
  const auto add = [&](double value, double error, int places, const char* unit) {
    if (error > value) return;
    text += (text.empty() ? "" : " and ") + detail::fixed(value, places) + " +- " +
            detail::fixed(error, places) + unit;
  };
  add(1e3 * drift.position(), 1e3 * drift.position_error(), digits, " mm");
  add(degrees * drift.rotation(), degrees * drift.rotation_error(), digits + 1, " degrees");
  return text;
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
  using detail::fixed;
  constexpr double much = 0.4;
  std::string line;
  const std::string apart = "images and joint states are about " +
                            fixed(1e3 * std::abs(time_offset.value), 0) + " +- " +
                            fixed(std::max(1.0, 2e3 * time_offset.sigma), 0) + " ms apart";
  if (seen_through > much) {
    line = "the sensor sees past " + fixed(100.0 * seen_through, 0) +
           " % of the robot: the camera is elsewhere than calibrated, or the joints are another "
           "robot's: run 'penumbra calibrate'";
  } else if (clocks_differ) {
    line = apart + ": set time_offset to " + fixed(time_offset.value, 3);
  } else if (has_moved || camera_or_clocks) {
    const std::string by = calibration::amount_of(*this, 1);
    line = by.empty() ? "the camera has moved since its calibration, how far is not known yet"
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
