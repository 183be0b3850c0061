// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 2 in any storage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace penumbra::io {

/// The QoS that a topic's publishers offered, by the bag.
struct OfferedQos {
  std::optional<bool> latched;  ///< at least one publisher was; nothing: the bag does not say
  bool is_unreadable = false;   ///< the bag has a QoS that cannot be read

  bool operator==(const OfferedQos&) const = default;
};

struct BagTopic {
  std::string name;  ///< "/joint_states"
  std::string type;  ///< "sensor_msgs/msg/JointState"
  /// The message definition with all nested messages ("ros2msg"), from the bag or else built in; of
  /// messages in protobuf the bag's FileDescriptorSet. Empty if there is neither.
  std::string definition;
  std::string encoding;                   ///< of the messages: "cdr", "protobuf"
  std::optional<std::uint64_t> messages;  ///< the number of messages, if the bag has a count
  OfferedQos qos = {};

  bool operator==(const BagTopic&) const = default;
  /// Returns whether both are the same topic, possibly of different publishers.
  [[nodiscard]] bool is_same_topic(const BagTopic& other) const {
    return name == other.name && type == other.type && definition == other.definition &&
           encoding == other.encoding;
  }
};

struct BagMessage {
  std::size_t topic = 0;            ///< index into topics()
  std::int64_t log_time = 0;        ///< time of recording, nanoseconds
  std::int64_t publish_time = 0;    ///< nanoseconds; log_time if the bag does not have it
  std::span<const std::byte> data;  ///< valid until the next call of next()
};

/// Reads the messages of a bag in the order of log time. Damaged parts are left out and reported by
/// faults().
class BagReader {
 public:
  BagReader() = default;
  BagReader(const BagReader&) = delete;
  BagReader& operator=(const BagReader&) = delete;
  virtual ~BagReader() = default;

  /// Returns the topics. Two topics with one name have different types. If a file's index is wrong,
  /// topics may be added while it is read.
  [[nodiscard]] virtual std::span<const BagTopic> topics() const = 0;

  /// Reads the next message. Returns false at the end.
  virtual bool next(BagMessage& message) = 0;

  /// Returns the faults found so far, one line each with the file's name. The list is complete at
  /// the end.
  [[nodiscard]] virtual std::span<const std::string> faults() const = 0;
};

/// Returns whether open_bag() opens files with this name.
[[nodiscard]] bool is_bag_file(const std::filesystem::path& file);

/// Returns whether open_bag() opens this folder: it has a metadata.yaml or bags, and no
/// recording.yaml, which marks a recording folder.
[[nodiscard]] bool is_bag_folder(const std::filesystem::path& folder);

/// Opens *.mcap, *.db3, one of these compressed as a whole (*.mcap.zstd) or the folder of a
/// recording: the files of its metadata.yaml or, without one, all bags in it. Throws InputError
/// that names the file if nothing can be read.
[[nodiscard]] std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path);

}  // namespace penumbra::io
