// SPDX-License-Identifier: Apache-2.0
// What an MCAP file holds: https://mcap.dev/spec
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace penumbra::io::mcap {

/// How the messages of channels are laid out.
struct Schema {
  std::uint16_t id = 0;  ///< never 0
  std::string name;      ///< "sensor_msgs/msg/Image"
  std::string encoding;  ///< of `data`: "ros2msg"
  std::string data;

  bool operator==(const Schema&) const = default;
};

/// One publisher's messages of one topic.
struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: none
  std::string topic;
  std::string message_encoding;  ///< "cdr"
  std::map<std::string, std::string> metadata;

  bool operator==(const Channel&) const = default;
};

struct Message {
  std::uint16_t channel = 0;  ///< id
  std::uint32_t sequence = 0;
  std::int64_t log_time = 0;      ///< nanoseconds: when it was recorded
  std::int64_t publish_time = 0;  ///< nanoseconds
  std::span<const std::byte> data;
};

/// What the writer counted.
struct Statistics {
  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0;
  std::uint32_t attachments = 0;
  std::uint32_t metadata = 0;
  std::uint32_t chunks = 0;
  std::uint64_t start_time = 0;                             ///< earliest log time, nanoseconds
  std::uint64_t end_time = 0;                               ///< latest log time, nanoseconds
  std::map<std::uint16_t, std::uint64_t> channel_messages;  ///< by channel id; empty: not counted
};

/// Something of a file that could not be read, or is not as it should be.
struct Fault {
  std::uint64_t offset = 0;  ///< byte of the file where it begins
  std::string what;          ///< one line: what is wrong and what was left out
};

/// No record may be longer: what claims to be is damaged.
inline constexpr std::uint64_t max_record_bytes = std::uint64_t{1} << 30;

}  // namespace penumbra::io::mcap
