// SPDX-License-Identifier: Apache-2.0
// What the readers of bags share.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <io/bag/bag_reader.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {

/// Open a bag of one storage. Both throw InputError if the file is not of that storage.
[[nodiscard]] std::unique_ptr<BagReader> open_mcap_bag(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<BagReader> open_sqlite_bag(const std::filesystem::path& file);

/// Returns whether a file is compressed by zstd, by its name: rosbag2 writes *.zstd, zstd *.zst.
[[nodiscard]] bool is_zstd_file(const std::filesystem::path& file);

/// Opens a compressed NAME.mcap.zstd or NAME.db3.zstd, which it decompresses into the folder for
/// temporary files.
[[nodiscard]] std::unique_ptr<BagReader> open_zstd_bag(const std::filesystem::path& file);

/// Opens a bag by the file's extension. Throws InputError for other extensions.
[[nodiscard]] std::unique_ptr<BagReader> open_bag_file(const std::filesystem::path& file);

/// Opens a recording of several files.
[[nodiscard]] std::unique_ptr<BagReader> open_bag_folder(const std::filesystem::path& folder);

/// Returns the bags in a folder, in no order.
[[nodiscard]] std::vector<std::filesystem::path> bags_in(const std::filesystem::path& folder,
                                                         std::error_code& fault);

/// Returns `text` if its encoding is ros2msg or protobuf, else the built-in definition of the type,
/// or an empty text.
[[nodiscard]] std::string definition_or_built_in(std::string_view type, std::string_view encoding,
                                                 std::string_view text);

/// Reads the QoS of the publishers that a recorder stored: a YAML list of profiles, with rmw's
/// numbers up to Humble and names since. An empty text gives an empty QoS.
[[nodiscard]] OfferedQos read_offered_qos(const std::string& profiles);

/// Reads the value in a metadata.yaml: a text or, since Jazzy, a list.
[[nodiscard]] OfferedQos read_offered_qos(const YamlNode& profiles);

/// Merges the QoS of further publishers into `qos`.
void merge(const OfferedQos& other, OfferedQos& qos);

/// Adds a topic to a list, or its publishers and messages to the same topic there. Returns its
/// index.
std::size_t add_topic(BagTopic topic, std::vector<BagTopic>& topics);

}  // namespace penumbra::io
