// SPDX-License-Identifier: Apache-2.0
#include "recording_bag.hpp"

#include "program.hpp"

#include <string>
#include <type_traits>
#include <variant>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>
#include <io/ros/image_codec.hpp>

namespace penumbra::test {
namespace {

constexpr const char* camera_frame = "camera_optical_frame";

io::CameraInfoMessage info_of(const Intrinsics& of) {
  io::CameraInfoMessage info{.header = {0, camera_frame},
                             .height = static_cast<std::uint32_t>(of.height()),
                             .width = static_cast<std::uint32_t>(of.width()),
                             .distortion_model = "plumb_bob",
                             .d = {0, 0, 0, 0, 0}};
  info.k = {of.fx(), 0, of.cx(), 0, of.fy(), of.cy(), 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {of.fx(), 0, of.cx(), 0, 0, of.fy(), of.cy(), 0, 0, 0, 1, 0};
  return info;
}

}  // namespace

TinyBag recording_bag(const std::filesystem::path& folder,
                      const Eigen::Isometry3d& T_parent_camera) {
  const auto recording = io::Recording::open(folder);
  const Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  TinyBag bag;
  const std::int64_t begin = *frames.read(0, false).stamp;
  bag.add("/robot_description", begin, io::StringMessage{read_file(recording.robots.front().urdf)});
  bag.add("/tf_static", begin,
          io::TfMessage{{{{0, recording.camera.parent}, camera_frame, T_parent_camera}}});
  io::CameraInfoMessage info = info_of(recording.camera.camera.intrinsics);
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
