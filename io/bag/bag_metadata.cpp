// SPDX-License-Identifier: Apache-2.0
#include <io/bag/bag_metadata.hpp>
#include <io/bag/offered_qos.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

// Up to version 3, paths begin with the recording's folder.
std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& name) {
  std::filesystem::path beside = folder / name;
  std::filesystem::path above = folder.parent_path() / name;
  std::error_code ignored;
  if (!std::filesystem::exists(beside, ignored) && std::filesystem::exists(above, ignored))
    return above;
  return beside;
}

void refuse_compression(const YamlNode& information) {
  const YamlNode* mode = information.find("compression_mode");
  if (mode == nullptr || mode->is_null()) return;
  const std::string& name = mode->text_or_empty();
  if (name.empty() || name == "NONE" || name == "none") return;
  if (name == "FILE" || name == "file")
    mode->fail(
        "files that are compressed as a whole are not read; 'zstd -d' on each, and an empty "
        "text here with their new names in relative_file_paths, make them readable");
  mode->fail("'" + name +
             "' is not read; 'ros2 bag convert' makes a bag without it, or with "
             "compressed chunks of MCAP");
}

}  // namespace

BagMetadata read_bag_metadata(const std::filesystem::path& file) {
  const YamlNode root = YamlNode::read(file);
  const YamlNode& information = root.at("rosbag2_bagfile_information");
  refuse_compression(information);
  BagMetadata metadata;
  const YamlNode& paths = information.at("relative_file_paths");
  for (const std::string& name : paths.texts())
    metadata.files.push_back(file_of(file.parent_path(), name));
  if (metadata.files.empty()) paths.fail("names no file; a recording has one at least");
  const YamlNode* topics = information.find("topics_with_message_count");
  if (topics == nullptr || topics->is_null()) return metadata;
  for (const YamlNode& topic : topics->items()) {
    const YamlNode& about = topic.at("topic_metadata");
    const std::int64_t count = topic.at("message_count").integer();
    if (count < 0) topic.at("message_count").fail("is negative; messages are counted from 0");
    const std::pair name_and_type(about.at("name").text(), about.at("type").text());
    metadata.messages[name_and_type] += static_cast<std::uint64_t>(count);
    if (const YamlNode* qos = about.find("offered_qos_profiles"))
      merge(read_offered_qos(*qos), metadata.qos[name_and_type]);
  }
  return metadata;
}

}  // namespace penumbra::io
