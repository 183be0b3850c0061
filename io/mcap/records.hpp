// SPDX-License-Identifier: Apache-2.0
// The content of an MCAP file: https://mcap.dev/spec
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace penumbra::io::mcap {

/// The message layout of channels.
struct Schema {
  std::uint16_t id = 0;  ///< never 0
  std::string name;      ///< "sensor_msgs/msg/Image"
  std::string encoding;  ///< of `data`: "ros2msg"
  std::string data;

  bool operator==(const Schema&) const = default;
};

/// The messages of one publisher of a topic.
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
  std::int64_t log_time = 0;      ///< time of recording, nanoseconds
  std::int64_t publish_time = 0;  ///< nanoseconds
  std::span<const std::byte> data;
};

/// The statistics of the writer.
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

/// A part of a file that is unreadable or wrong.
struct Fault {
  std::uint64_t offset = 0;  ///< offset in the file
  std::string what;          ///< one line: the fault and what was left out
};

/// The largest record. A record that claims more is damaged.
inline constexpr std::uint64_t max_record_bytes = std::uint64_t{1} << 30;

}  // namespace penumbra::io::mcap
