// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/files/disk_file.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

OfferedQos qos_of_list(const YamlNode& profiles) {
  OfferedQos qos;
  for (const YamlNode& profile : profiles.items()) {
    const YamlNode* durability_node = profile.find("durability");
    if (durability_node == nullptr) continue;
    const std::string& durability = durability_node->text();
    if (durability == "1" || durability == "transient_local") qos.latched = true;
    if (durability == "2" || durability == "volatile") qos.latched = qos.latched.value_or(false);
  }
  return qos;
}

template <typename F>
OfferedQos read_or_unreadable(const F& read) {
  try {
    return read();
  } catch (const InputError&) {
    return {.latched = {}, .is_unreadable = true};
  }
}

/// Throws InputError for a bag of ROS 1, which RealSense's SDK writes, too.
void refuse_ros1(const std::filesystem::path& file) {
  constexpr std::string_view start = "#ROSBAG V";
  InputFile input;
  std::string text(start.size(), '\0');
  if (!input.open(file).ok() || input.read(text.data(), text.size()) != text.size() ||
      text != start)
    return;
  throw InputError(file.string() +
                   ": is a bag of ROS 1 or a recording of RealSense's SDK, which are not read; "
                   "convert a bag by `rosbags-convert --src " +
                   file.string() + " --dst " +
                   std::filesystem::path(file).replace_extension().string() +
                   "`, of the Python package rosbags; play a recording with realsense2_camera and "
                   "record its topics with ros2 bag");
}

}  // namespace

std::unique_ptr<BagReader> open_bag_file(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_empty(file, error))
    throw InputError(file.string() + ": is empty: nothing was recorded");
  refuse_ros1(file);
  if (file.extension() == ".mcap") return open_mcap_bag(file);
  if (file.extension() == ".db3") return open_sqlite_bag(file);
  if (is_bag_file(file) && is_zstd_file(file)) return open_zstd_bag(file);
  if (!std::filesystem::exists(file, error))
    throw InputError(file.string() + ": cannot be read: No such file or directory");
  throw InputError(file.string() +
                   ": is not a bag; *.mcap, *.db3, these with .zstd behind, and folders with a "
                   "metadata.yaml are");
}

std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return open_bag_folder(path);
  return open_bag_file(path);
}

std::string definition_or_built_in(std::string_view type, std::string_view encoding,
                                   std::string_view text) {
  const bool is_understood = encoding == "ros2msg" || encoding == "protobuf";
  if (is_understood && !text.empty()) return std::string(text);
  return std::string(definition_of(type));
}

OfferedQos read_offered_qos(const std::string& profiles) {
  if (profiles.empty()) return {};
  return read_or_unreadable([&] {
    const YamlNode list = YamlNode::parse(profiles, "offered_qos_profiles");
    return list.is_null() ? OfferedQos{} : qos_of_list(list);
  });
}

OfferedQos read_offered_qos(const YamlNode& profiles) {
  if (profiles.is_null()) return {};
  return read_or_unreadable([&] {
    return profiles.is_list() ? qos_of_list(profiles) : read_offered_qos(profiles.text_or_empty());
  });
}

void merge(const OfferedQos& other, OfferedQos& qos) {
  if (other.latched) qos.latched = *other.latched || qos.latched.value_or(false);
  qos.is_unreadable |= other.is_unreadable;
}

std::size_t add_topic(BagTopic topic, std::vector<BagTopic>& topics) {
  const auto known = std::find_if(topics.begin(), topics.end(), [&](const BagTopic& other) {
    return other.is_same_topic(topic);
  });
  const auto index = static_cast<std::size_t>(known - topics.begin());
  if (known == topics.end()) {
    topics.push_back(std::move(topic));
    return index;
  }
  merge(topic.qos, known->qos);
  if (known->messages && topic.messages)
    *known->messages += *topic.messages;
  else
    known->messages.reset();
  return index;
}

}  // namespace penumbra::io
