// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <io/bag/bag_reader.hpp>

namespace penumbra::io {

/// The two storages; each throws InputError where the file is not one of its kind.
[[nodiscard]] std::unique_ptr<BagReader> open_mcap_bag(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<BagReader> open_sqlite_bag(const std::filesystem::path& file);

/// One of both, by the file's name. Throws InputError for other names.
[[nodiscard]] std::unique_ptr<BagReader> open_bag_file(const std::filesystem::path& file);

/// A recording of several files.
[[nodiscard]] std::unique_ptr<BagReader> open_bag_folder(const std::filesystem::path& folder);

/// Whether the name is that of a file that open_bag_file() opens.
[[nodiscard]] bool is_bag_file(const std::filesystem::path& file);

/// Whether a folder is one that open_bag_folder() opens: a metadata.yaml or bags lie there, and no
/// recording.yaml, which makes it a recording folder.
[[nodiscard]] bool is_bag_folder(const std::filesystem::path& folder);

/// `text` if it is ros2msg, else the built-in definition of the type, or nothing.
[[nodiscard]] std::string definition_or_built_in(std::string_view type, std::string_view encoding,
                                                 std::string_view text);

}  // namespace penumbra::io
