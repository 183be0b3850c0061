// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// The keys of a camera's calibration: its number of poses, then its state.
inline constexpr const char* calibration_poses_key = "calibration poses";
inline constexpr const char* calibration_key = "calibration";

/// Finds changes between successive diagnostics.
class DiagnosticChanges {
 public:
  /// Returns a line for each status whose fault changed or ended since the last call, and one with
  /// all messages once there is no fault; and a line for each new state of a calibration. A change
  /// of the numbers in a message, for example of a duration, does not count.
  [[nodiscard]] std::vector<std::string> update(const DiagnosticArrayMessage& message);

 private:
  std::optional<std::map<std::string, std::string>> reported_;  // kinds of faults, by status name
  std::map<std::string, std::string> calibrations_;             // kinds of states, by status name
};

}  // namespace penumbra::io
