// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace penumbra::io {

/// From now on what Cyclone DDS logs in this process is kept, the last 100 lines, in place of being
/// printed.
void keep_logged_lines();

/// The lines since the last call.
[[nodiscard]] std::vector<std::string> take_logged_lines();

}  // namespace penumbra::io
