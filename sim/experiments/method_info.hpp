// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace penumbra::sim {

/// A way of dealing with the robot in the picture, in words.
struct MethodInfo {
  std::string key;   ///< in metrics.json
  std::string name;  ///< in the report
  std::string idea;  ///< what it does and what it was given, a sentence or two
};

}  // namespace penumbra::sim
