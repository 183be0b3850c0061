// SPDX-License-Identifier: Apache-2.0
#include "tiny_recording.hpp"

#include "../support/pixels.hpp"
#include "program.hpp"

#include <penumbra/base/image.hpp>
#include <penumbra/mesh/primitives.hpp>

#include <io/files/png.hpp>
#include <io/files/stl_file.hpp>

namespace penumbra::test {
namespace {

constexpr const char* tiny_urdf = R"(<robot name="tiny">
  <link name="base"/>
  <link name="board">
    <collision><geometry><mesh filename="board.stl"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="board"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
)";

constexpr const char* recording_yaml = R"(robot:
  urdf: tiny.urdf
camera:
  info: camera_info.yaml
  parent: base
  pose: camera_pose.csv
frames:
  joints: joint_states.csv
  depth: depth_%d.png
  color: color_%d.png
)";

constexpr const char* camera_info = R"(width: 64
height: 48
distortion_model: plumb_bob
d: [0.0, 0.0, 0.0, 0.0, 0.0]
k: [60.0, 0.0, 31.3, 0.0, 60.0, 23.7, 0.0, 0.0, 1.0]
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
p: [60.0, 0.0, 31.3, 0.0, 0.0, 60.0, 23.7, 0.0, 0.0, 0.0, 1.0, 0.0]
)";

Image<std::uint16_t> depth_image(double board) {
  Image<std::uint16_t> depth(tiny_width, tiny_height, 3000);
  for (const auto [u, v] : each_pixel(depth)) {
    const double x = (u - 31.3) / 60.0 * board, y = (v - 23.7) / 60.0 * board;
    const bool on_board = x > -0.2 && x < 0.2 && y > -0.1 && y < 0.1;
    if (on_board) depth(u, v) = static_cast<std::uint16_t>(1000.0 * board);
  }
  for (const auto [u, v] : each_pixel(24, 20, 32, 28)) depth(u, v) = 500;  // an object
  for (const auto [u, v] : each_pixel(36, 20, 40, 28)) depth(u, v) = 0;    // a hole
  return depth;
}

}  // namespace

void write_tiny_recording(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_file(folder / "tiny.urdf", tiny_urdf);
  io::write_stl(folder / "board.stl", make_box({0.4, 0.2, 0.1}));
  write_file(folder / "recording.yaml", recording_yaml);
  write_file(folder / "camera_info.yaml", camera_info);
  write_file(folder / "camera_pose.csv", "1,0,0,0\n0,1,0,0\n0,0,1,0\n0,0,0,1\n");
  write_file(folder / "joint_states.csv", "frame,slide\n0,0.0\n1,0.05\n2,0.1\n");
  const Image<Rgb8> color(tiny_width, tiny_height, {90, 120, 150});
  for (int i = 0; i < 3; ++i) {
    const std::string ending = std::to_string(i) + ".png";
    const Image<std::uint16_t> depth = depth_image(0.95 + 0.05 * i);
    io::write_png(folder / ("depth_" + ending), depth.view());
    io::write_png(folder / ("color_" + ending), color.view());
  }
}

}  // namespace penumbra::test
