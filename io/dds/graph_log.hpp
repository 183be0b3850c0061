// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace penumbra::io {

/// Keeps the last 100 log lines of Cyclone DDS in this process from now on, instead of printing
/// them.
void keep_logged_lines();

/// Returns the lines since the last call.
[[nodiscard]] std::vector<std::string> take_logged_lines();

}  // namespace penumbra::io
