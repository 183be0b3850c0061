// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <io/ros/message_decoder.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::test {

/// Messages of a bag as they are before they are written.
struct TinyBag {
  struct Message {
    std::string topic, type;
    std::int64_t log_time = 0;  ///< nanoseconds
    std::vector<std::byte> data;
  };
  std::vector<Message> messages;
  std::string encoding = "cdr";
  std::string profile = "ros2";
  std::map<std::string, std::string> qos;  ///< offered_qos_profiles of topics, if they are told

  template <typename M>
  void add(const std::string& topic, std::int64_t log_time, const M& message) {
    messages.push_back({topic, io::message_type<M>(), log_time, {}});
    io::encode(message, messages.back().data);
  }

  /// The messages of one topic are decoded, changed and encoded again.
  template <typename M>
  void edit(const std::string& topic, const std::function<void(M&)>& change) {
    const io::Decoder<M> decoder;
    for (Message& message : messages) {
      if (message.topic != topic) continue;
      const std::vector<std::byte> before = message.data;
      M decoded;
      if (decoder.decode(before, decoded)) std::abort();
      change(decoded);
      io::encode(decoded, message.data);
    }
  }

  void remove(const std::string& topic);
  void rename(const std::string& from, const std::string& to);
  /// The same messages on another topic, too.
  void copy(const std::string& from, const std::string& to);

  void write_mcap(const std::filesystem::path& file) const;
  /// A bag of Humble, without definitions.
  void write_sqlite(const std::filesystem::path& file) const;
};

/// Stamp of a frame of tiny_bag(), nanoseconds.
constexpr std::int64_t tiny_stamp(int frame) { return 100'000'000'000 + 400'000'000LL * frame; }

/// Of its board, m/s.
constexpr double tiny_speed = 0.125;

/// What a camera and a robot would have said of write_tiny_recording(folder): the board slides
/// evenly through the frames' positions, 0.4 s apart; joint states at 20 Hz, none of them on a
/// frame's stamp; the camera on link "base" through two static transforms; images come 30 ms after
/// their stamps. Depth: /camera/depth/image_rect_raw, color: /camera/color/image_raw/compressed,
/// both of the frame "optical".
[[nodiscard]] TinyBag tiny_bag(const std::filesystem::path& folder);

}  // namespace penumbra::test
