// SPDX-License-Identifier: Apache-2.0
#include "real_frames.hpp"

#include "pixels.hpp"

#include <algorithm>
#include <string>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/png.hpp>
#include <io/files/recording.hpp>

namespace penumbra::test {
namespace {

RealFrame real_frame(const Intrinsics& intrinsics, const VirtualDepthView& rendered,
                     Image<std::uint16_t> measured) {
  RealFrame frame{.intrinsics = intrinsics,
                  .robot = {intrinsics.width(), intrinsics.height()},
                  .tiles = *rendered.touched,
                  .measured = std::move(measured)};
  for (const auto [u, v] : each_pixel(intrinsics)) {
    frame.robot(u, v) = rendered.depth(u, v);
    if (rendered.depth(u, v) > 0.0f) frame.robot_indices.push_back(v * intrinsics.width() + u);
  }
  return frame;
}

}  // namespace

std::vector<RealFrame> load_real_frames(const std::filesystem::path& folder) {
  const io::Recording recording = io::Recording::open(folder);
  const Robot robot = recording.load_robot();
  const Intrinsics& intrinsics = recording.camera.camera.intrinsics;
  const std::vector<Body> bodies = bodies_of(robot);
  const auto renderer = make_depth_renderer(Backend::reference, intrinsics, bodies);
  const io::FrameReader reader(recording, robot);
  const std::size_t parent = robot.find_link(recording.camera.camera.parent).value();
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::vector<RealFrame> frames;
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const Frame frame = reader.read(i, false);
    if (frame.pose.status != FrameStatus::ok) throw InputError(frame.pose.message);
    if (frame.source_status != FrameStatus::ok) throw InputError(frame.source_message);
    robot.forward_kinematics(frame.pose.positions, poses);
    const Eigen::Isometry3d T_camera_root =
        (poses[parent] * *recording.camera.camera.T_parent_camera).inverse();
    for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
    frames.push_back(
        real_frame(intrinsics, renderer->render(poses),
                   io::copy_of(std::get<ImageView<const std::uint16_t>>(frame.depth.view))));
    const std::filesystem::path name =
        recording.file.parent_path() / ("robot_mask_" + std::to_string(*frame.index) + ".png");
    if (!exists(name)) continue;
    Image<std::uint8_t> mask;
    io::read_png(name, mask).require();
    frames.back().mask_pixels = std::size_t(
        std::count_if(mask.data(), mask.data() + mask.size(), [](auto m) { return m != 0; }));
  }
  return frames;
}

}  // namespace penumbra::test
