// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../io/foxglove_encoder.hpp"
#include "../io/messages.hpp"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include <Eigen/Geometry>

#include <io/bag/bag_reader.hpp>

namespace penumbra::test {

/// Calls `call(message, log_time, number)` with each message of a topic of a bag, in their order,
/// and returns their count.
template <typename M, typename Call>
std::size_t for_each_message(const std::filesystem::path& file, const std::string& topic,
                             const Call& call) {
  const auto bag = io::open_bag(file);
  std::size_t number = 0;
  M decoded;
  for (io::BagMessage message; bag->next(message);) {
    const io::BagTopic& from = bag->topics()[message.topic];
    if (from.name != topic) continue;
    EXPECT_FALSE(io::Decoder<M>(from.type, from.definition).decode(message.data, decoded));
    call(decoded, message.log_time, number++);
  }
  EXPECT_TRUE(bag->faults().empty());
  return number;
}

[[nodiscard]] std::map<std::string, std::size_t> topic_counts(const std::filesystem::path& file);

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

  /// The messages of one type, or of one topic, are decoded, changed and encoded again.
  template <typename M>
  void edit(const std::function<void(M&)>& change) {
    edit("", change);
  }
  template <typename M>
  void edit(const std::string& topic, const std::function<void(M&)>& change) {
    const io::Decoder<M> decoder;
    for (Message& message : messages) {
      if (topic.empty() ? message.type != io::message_type<M>() : message.topic != topic) continue;
      const std::vector<std::byte> before = message.data;
      M decoded;
      if (decoder.decode(before, decoded)) std::abort();
      change(decoded);
      io::encode(decoded, message.data);
    }
  }

  /// All messages become those of Foxglove's schemas in protobuf, which have no robot_description.
  void to_foxglove();
  std::string schemas = foxglove::descriptors();  ///< of such messages

  void remove(const std::string& topic);
  void rename(const std::string& from, const std::string& to);
  /// The frames of /tf and /tf_static.
  void rename_frames(const std::function<std::string(const std::string&)>& renamed);
  void copy(const std::string& from, const std::string& to);
  void sort();
  /// Adds what robot_state_publisher sends of the tiny board, on /tf at 10 Hz.
  void add_board_frames();

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

/// Returns the frames of a recording folder as its robot and camera would publish them: joint
/// states, depth (/camera/depth/image) and colour (/camera/color/image), if there is any, with the
/// stamps of the frames, which need them; and the frame "camera_optical_frame" of both at this pose
/// on the camera's link, in tf_static.
[[nodiscard]] TinyBag recording_bag(const std::filesystem::path& folder,
                                    const Eigen::Isometry3d& T_parent_camera);

}  // namespace penumbra::test
