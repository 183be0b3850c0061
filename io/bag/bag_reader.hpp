// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 2, whatever they are stored in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace penumbra::io {

/// What a bag tells of how a topic's publishers offered it.
struct OfferedQos {
  std::optional<bool> latched;  ///< one of them was, at least; nothing: the bag does not tell
  bool is_unreadable = false;   ///< it tells, but that cannot be read

  bool operator==(const OfferedQos&) const = default;
};

struct BagTopic {
  std::string name;  ///< "/joint_states"
  std::string type;  ///< "sensor_msgs/msg/JointState"
  /// The type's text with those of all messages in it ("ros2msg"): the bag's own, or else the built
  /// in one; empty where there is neither.
  std::string definition;
  std::string encoding;                   ///< of its messages: "cdr"
  std::optional<std::uint64_t> messages;  ///< how many, where the bag tells
  OfferedQos qos = {};

  bool operator==(const BagTopic&) const = default;
  /// Whether messages of both are of one topic, whoever publishes them.
  [[nodiscard]] bool is_same_topic(const BagTopic& other) const {
    return name == other.name && type == other.type && definition == other.definition &&
           encoding == other.encoding;
  }
};

struct BagMessage {
  std::size_t topic = 0;            ///< index into topics()
  std::int64_t log_time = 0;        ///< nanoseconds: when it was recorded
  std::int64_t publish_time = 0;    ///< nanoseconds; log_time where the bag does not tell
  std::span<const std::byte> data;  ///< valid until the next call of next()
};

/// Gives the messages of a bag by log time. What of the bag is damaged is left out and told.
class BagReader {
 public:
  BagReader() = default;
  BagReader(const BagReader&) = delete;
  BagReader& operator=(const BagReader&) = delete;
  virtual ~BagReader() = default;

  /// Two topics of one name have different types. Files whose index lies may add topics while they
  /// are read.
  [[nodiscard]] virtual std::span<const BagTopic> topics() const = 0;

  /// False at the end.
  virtual bool next(BagMessage& message) = 0;

  /// What was found wrong so far, one line each, which names the file. All of it is known at the
  /// end.
  [[nodiscard]] virtual std::span<const std::string> faults() const = 0;
};

/// Opens *.mcap, *.db3 or the folder of a recording: the files of its metadata.yaml, or, where that
/// is missing, all that lie there. Throws InputError that names the file where nothing can be read
/// of it.
[[nodiscard]] std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path);

}  // namespace penumbra::io
