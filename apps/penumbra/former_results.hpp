// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace penumbra::app {

/// Removes what an earlier `run` wrote into a folder: report.json and images by frame number. What
/// is not there is no fault. Throws InputError where something stands in the way or cannot be
/// removed, or `folder` is no folder.
void remove_former_run(const std::filesystem::path& folder);

/// Removes the file that `option` is to write; what is no regular file (/dev/null) stays. Throws
/// InputError for a folder.
void remove_former_file(const std::string& option, const std::filesystem::path& file);

}  // namespace penumbra::app
