// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <io/assembly/cloud_input.hpp>

namespace penumbra::io {

/// Reads "TOPIC", which words with spaces between may follow: sensor=NAME (CloudRule::for_sensor),
/// SETTING=N (CloudRule::settings), merged, sensor_frame=FRAME, time_offset=S, ignore_times,
/// removed_ranges=inf. Throws InputError.
[[nodiscard]] CloudInputOptions parse_cloud(const std::string& text);

}  // namespace penumbra::io
