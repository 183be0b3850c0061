// SPDX-License-Identifier: Apache-2.0
#include "tiny_bag.hpp"

#include "../io/bag_files.hpp"
#include "program.hpp"
#include "tiny_recording.hpp"

#include <algorithm>
#include <map>

#include <io/files/image_size.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t millisecond = 1'000'000;

io::CameraInfoMessage tiny_camera() {
  io::CameraInfoMessage info{.header = {0, "optical"},
                             .height = tiny_height,
                             .width = tiny_width,
                             .distortion_model = "plumb_bob",
                             .d = {0, 0, 0, 0, 0}};
  info.k = {60, 0, 31.3, 0, 60, 23.7, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {60, 0, 31.3, 0, 0, 60, 23.7, 0, 0, 0, 1, 0};
  return info;
}

Eigen::Isometry3d shift(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); }

void add_frame(TinyBag& bag, int frame, const std::filesystem::path& folder) {
  const std::int64_t stamp = tiny_stamp(frame), arrival = stamp + 30 * millisecond;
  const std::string ending = "_" + std::to_string(frame) + ".png";
  Image<std::uint16_t> depth;
  Image<Rgb8> color;
  io::read_png(folder / ("depth" + ending), depth).require();
  io::read_png(folder / ("color" + ending), color).require();
  io::CameraInfoMessage info = tiny_camera();
  info.header.stamp = stamp;
  bag.add("/camera/depth/camera_info", arrival, info);
  bag.add("/camera/depth/image_rect_raw", arrival,
          io::image_message(info.header, "16UC1", std::as_const(depth).view()));
  std::vector<std::byte> png;
  bag.add("/camera/color/image_raw/compressed", arrival,
          io::png_message(info.header, std::as_const(color).view(), png));
}

void add_joints(TinyBag& bag) {
  for (std::int64_t stamp = tiny_stamp(0) - 170 * millisecond; stamp < tiny_stamp(3);
       stamp += 50 * millisecond) {
    const double seconds = static_cast<double>(stamp - tiny_stamp(0)) * 1e-9;
    bag.add("/joint_states", stamp + millisecond,
            io::JointStateMessage{.header = {stamp, ""},
                                  .names = {"other", "slide"},
                                  .positions = {9.0, tiny_speed * seconds}});
  }
}

}  // namespace

void TinyBag::remove(const std::string& topic) {
  std::erase_if(messages, [&](const Message& message) { return message.topic == topic; });
}

void TinyBag::rename(const std::string& from, const std::string& to) {
  for (Message& message : messages)
    if (message.topic == from) message.topic = to;
}

void TinyBag::copy(const std::string& from, const std::string& to) {
  const std::vector<Message> before = messages;
  for (Message message : before) {
    if (message.topic != from) continue;
    message.topic = to;
    messages.push_back(std::move(message));
  }
}

void TinyBag::write_mcap(const std::filesystem::path& file) const {
  io::mcap::Writer writer(
      file, {.compression = io::mcap::Compression::none, .chunk_size = 4096, .profile = profile});
  std::map<std::string, std::uint16_t> channels;
  for (const Message& message : messages) {
    auto channel = channels.find(message.topic);
    if (channel == channels.end()) {
      const auto schema =
          writer.add_schema(message.type, "ros2msg", std::string(io::definition_of(message.type)));
      const auto told = qos.find(message.topic);
      const auto id = told == qos.end()
                          ? writer.add_channel(message.topic, encoding, schema)
                          : writer.add_channel(message.topic, encoding, schema,
                                               {{"offered_qos_profiles", told->second}});
      channel = channels.emplace(message.topic, id).first;
    }
    writer.write(channel->second, message.log_time, message.log_time, 0, message.data);
  }
  writer.close();
}

void TinyBag::write_sqlite(const std::filesystem::path& file) const {
  BagDatabase database(file);
  database.make_tables(false);
  std::map<std::string, int> ids;
  for (const Message& message : messages) {
    const auto [topic, is_new] = ids.emplace(message.topic, static_cast<int>(ids.size()) + 1);
    if (is_new) {
      const auto told = qos.find(message.topic);
      database.topic(topic->second, message.topic, message.type,
                     told == qos.end() ? "" : told->second);
    }
    database.message(topic->second, message.log_time,
                     {reinterpret_cast<const char*>(message.data.data()), message.data.size()});
  }
}

TinyBag tiny_bag(const std::filesystem::path& folder) {
  TinyBag bag;
  const std::int64_t before = tiny_stamp(0) - 200 * millisecond;
  bag.add("/robot_description", before, io::StringMessage{read_file(folder / "tiny.urdf")});
  bag.add("/tf_static", before, io::TfMessage{{{{0, "base"}, "mount", shift(0.25)}}});
  bag.add("/tf_static", before + 1, io::TfMessage{{{{0, "mount"}, "optical", shift(-0.25)}}});
  add_joints(bag);
  for (int frame = 0; frame < 3; ++frame) add_frame(bag, frame, folder);
  std::stable_sort(bag.messages.begin(), bag.messages.end(),
                   [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
  return bag;
}

}  // namespace penumbra::test
