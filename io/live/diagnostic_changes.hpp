// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Finds changes between successive diagnostics.
class DiagnosticChanges {
 public:
  /// Returns a line for each status whose fault changed or ended since the last call. A change of
  /// the numbers in a message, for example of a duration, does not count.
  [[nodiscard]] std::vector<std::string> update(const DiagnosticArrayMessage& message);

 private:
  std::map<std::string, std::string> reported_;  // kinds of faults, by status name
};

}  // namespace penumbra::io
