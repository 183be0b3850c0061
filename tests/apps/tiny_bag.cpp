// SPDX-License-Identifier: Apache-2.0
#include "tiny_bag.hpp"

#include "../io/bag_files.hpp"
#include "program.hpp"
#include "tiny_recording.hpp"

#include <variant>

#include <io/files/frame_reader.hpp>
#include <io/files/image_size.hpp>
#include <io/files/recording.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t millisecond = 1'000'000;

Eigen::Isometry3d shift(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); }

void add_frame(TinyBag& bag, int frame, const std::filesystem::path& folder) {
  const std::int64_t stamp = tiny_stamp(frame), arrival = stamp + 30 * millisecond;
  const std::string ending = "_" + std::to_string(frame) + ".png";
  Image<std::uint16_t> depth;
  Image<Rgb8> color;
  io::read_png(folder / ("depth" + ending), depth).require();
  io::read_png(folder / ("color" + ending), color).require();
  const io::CameraInfoMessage info =
      camera_info_of({tiny_width, tiny_height, 60, 60, 31.3, 23.7}, {stamp, "optical"});
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
    const double since = static_cast<double>(stamp - tiny_stamp(0)) * 1e-9;
    bag.add("/joint_states", stamp + millisecond,
            io::JointStateMessage{.header = {stamp, ""},
                                  .names = {"other", "slide"},
                                  .positions = {9.0, tiny_speed * since}});
  }
}

}  // namespace

std::map<std::string, std::size_t> topic_counts(const std::filesystem::path& file) {
  std::map<std::string, std::size_t> counts;
  const auto bag = io::open_bag(file);
  for (io::BagMessage message; bag->next(message);) ++counts[bag->topics()[message.topic].name];
  return counts;
}

void TinyBag::to_foxglove() {
  remove("/robot_description");
  for (Message& message : messages) {
    std::string bytes;
    const auto convert = [&]<typename M>(M out, const char* schema) {
      if (message.type != io::message_type<M>()) return;
      if (io::Decoder<M>().decode(message.data, out)) std::abort();
      bytes = foxglove::encode(out);
      message.type = schema;
    };
    convert(io::ImageMessage(), "foxglove.RawImage");
    convert(io::CompressedImageMessage(), "foxglove.CompressedImage");
    convert(io::CameraInfoMessage(), "foxglove.CameraCalibration");
    convert(io::JointStateMessage(), "foxglove.JointStates");
    convert(io::TfMessage(), "foxglove.FrameTransforms");
    const auto span = std::as_bytes(std::span(bytes));
    message.data.assign(span.begin(), span.end());
  }
}

void TinyBag::sort() {
  std::stable_sort(messages.begin(), messages.end(),
                   [](const Message& a, const Message& b) { return a.log_time < b.log_time; });
}

void TinyBag::add_board_frames() {
  for (std::int64_t stamp = tiny_stamp(0) - 130 * millisecond; stamp < tiny_stamp(3);
       stamp += 100 * millisecond) {
    const double since = static_cast<double>(stamp - tiny_stamp(0)) * 1e-9;
    const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 1 + tiny_speed * since));
    add("/tf", stamp, io::TfMessage{{{{stamp, "base"}, "board", pose}}});
  }
}

void TinyBag::remove(const std::string& topic) {
  std::erase_if(messages, [&](const Message& message) { return message.topic == topic; });
}

void TinyBag::rename(const std::string& from, const std::string& to) {
  for (Message& message : messages)
    if (message.topic == from) message.topic = to;
}

void TinyBag::rename_frames(const std::function<std::string(const std::string&)>& renamed) {
  for (const char* const topic : {"/tf", "/tf_static"})
    edit<io::TfMessage>(topic, [&](auto& tf) {
      for (io::TransformMessage& transform : tf.transforms) {
        transform.header.frame_id = renamed(transform.header.frame_id);
        transform.child_frame_id = renamed(transform.child_frame_id);
      }
    });
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
      const bool is_protobuf = message.type.starts_with("foxglove.");
      const auto schema = is_protobuf
                              ? writer.add_schema(message.type, "protobuf", schemas)
                              : writer.add_schema(message.type, "ros2msg",
                                                  std::string(io::definition_of(message.type)));
      std::map<std::string, std::string> more;
      if (qos.contains(message.topic)) more = {{"offered_qos_profiles", qos.at(message.topic)}};
      const auto id =
          writer.add_channel(message.topic, is_protobuf ? "protobuf" : encoding, schema, more);
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
    if (is_new)
      database.topic(topic->second, message.topic, message.type,
                     qos.contains(message.topic) ? qos.at(message.topic) : "");
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
  bag.sort();
  return bag;
}

TinyBag recording_bag(const std::filesystem::path& folder,
                      const Eigen::Isometry3d& T_parent_camera) {
  const auto recording = io::Recording::open(folder);
  const Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  const std::string camera_frame = "camera_optical_frame";
  TinyBag bag;
  const std::int64_t begin = *frames.read(0, false).stamp;
  bag.add("/robot_description", begin, io::StringMessage{read_file(recording.robots.front().urdf)});
  bag.add("/tf_static", begin,
          io::TfMessage{{{{0, recording.camera.camera.parent}, camera_frame, T_parent_camera}}});
  io::CameraInfoMessage info =
      camera_info_of(recording.camera.camera.intrinsics, {0, camera_frame});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame frame = frames.read(i, recording.frames.color.has_value());
    info.header.stamp = *frame.stamp;
    bag.add("/joint_states", *frame.stamp,
            io::JointStateMessage{.header = {*frame.stamp, ""},
                                  .names = {robot.variables().begin(), robot.variables().end()},
                                  .positions = frame.pose.positions});
    bag.add("/camera/depth/camera_info", *frame.stamp, info);
    std::visit(
        [&](const auto& depth) {
          const bool is_metres = std::is_same_v<std::decay_t<decltype(*depth.data)>, float>;
          bag.add("/camera/depth/image", *frame.stamp,
                  io::image_message(info.header, is_metres ? "32FC1" : "16UC1", depth));
        },
        frame.depth.view);
    if (frame.color.view.empty()) continue;
    bag.add("/camera/color/image", *frame.stamp,
            io::image_message(info.header, "rgb8", frame.color.view));
  }
  return bag;
}

}  // namespace penumbra::test
