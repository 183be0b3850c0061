// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <io/bag/bag_reader.hpp>

namespace penumbra::io {

/// Open a bag of one storage. Both throw InputError if the file is not of that storage.
[[nodiscard]] std::unique_ptr<BagReader> open_mcap_bag(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<BagReader> open_sqlite_bag(const std::filesystem::path& file);

/// Opens a bag by the file's extension. Throws InputError for other extensions.
[[nodiscard]] std::unique_ptr<BagReader> open_bag_file(const std::filesystem::path& file);

/// Opens a recording of several files.
[[nodiscard]] std::unique_ptr<BagReader> open_bag_folder(const std::filesystem::path& folder);

/// Returns whether open_bag_file() opens files with this name.
[[nodiscard]] bool is_bag_file(const std::filesystem::path& file);

/// Returns whether open_bag_folder() opens this folder: it has a metadata.yaml or bags, and no
/// recording.yaml, which marks a recording folder.
[[nodiscard]] bool is_bag_folder(const std::filesystem::path& folder);

/// Returns `text` if its encoding is ros2msg, else the built-in definition of the type, or an empty
/// text.
[[nodiscard]] std::string definition_or_built_in(std::string_view type, std::string_view encoding,
                                                 std::string_view text);

}  // namespace penumbra::io
