// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace penumbra::io {

/// Returns the value of an environment variable, or an empty string.
[[nodiscard]] std::string environment(const char* name);

/// Returns the addresses in ROS_STATIC_PEERS. Throws InputError for one that is none.
[[nodiscard]] std::vector<std::string> static_peers();

}  // namespace penumbra::io
