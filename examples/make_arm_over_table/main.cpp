// SPDX-License-Identifier: Apache-2.0
// Makes the shipped recording: a six-axis arm over a table, seen by a stereo depth camera.
//   make_arm_over_table FOLDER [FIRST LAST]   all frames, or those from FIRST to LAST
#include "arm.hpp"
#include "png_file.hpp"
#include "scene.hpp"
#include "sensor.hpp"
#include "text.hpp"

#include <exception>
#include <iostream>
#include <sstream>

namespace {

using namespace example;

constexpr std::int64_t first_stamp = 1'700'000'000'000'000'000;  // nanoseconds
constexpr std::int64_t period = 100'000'000;                     // nanoseconds
constexpr std::uint64_t seed = 20'260'101;

std::string camera_info() {
  const std::string fx = shortest(View::fx), fy = shortest(View::fy);
  const std::string cx = shortest(View::cx), cy = shortest(View::cy);
  return "# SPDX-License-Identifier: Apache-2.0\nframe_id: camera_optical_frame\nwidth: " +
         std::to_string(View::width) + "\nheight: " + std::to_string(View::height) +
         "\ndistortion_model: plumb_bob\nd: [0, 0, 0, 0, 0]\nk: [" + fx + ", 0, " + cx + ", 0, " +
         fy + ", " + cy + ", 0, 0, 1]\nr: [1, 0, 0, 0, 1, 0, 0, 0, 1]\np: [" + fx + ", 0, " + cx +
         ", 0, 0, " + fy + ", " + cy + ", 0, 0, 0, 1, 0]\n";
}

std::string camera_pose(const View& view) {
  std::string text;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      text += fixed(view.T_base_camera.matrix()(r, c), 12) + (c < 3 ? "," : "\n");
  return text;
}

std::string joint_states() {
  std::ostringstream text;
  text << "frame,stamp";
  for (const auto& name : Arm::value_names()) text << ',' << name;
  text << '\n';
  for (int i = 0; i < Scene::frame_count; ++i) {
    text << i << ',' << first_stamp + i * period;
    for (const double value : Scene::joints(i)) text << ',' << shortest(value);
    text << '\n';
  }
  return text.str();
}

constexpr const char* recording = R"(# SPDX-License-Identifier: Apache-2.0
# A six-axis arm over a table, drawn and measured by examples/make_arm_over_table. Paths are
# relative to this file.
robot:
  urdf: arm_description/arm.urdf
  packages:                      # package://NAME/... resolves to these folders
    arm_description: arm_description
camera:
  info: camera_info.yaml         # ROS camera_info YAML
  parent: base_link              # robot link that the pose is given in
  pose: camera_pose.csv          # 4x4 row-major, metres: optical frame to parent link
frames:
  joints: joint_states.csv       # header: frame,stamp,JOINT,...; nanoseconds, radians, metres
  depth: depth/%d.png            # 16-bit, millimetres, 0 = no measurement
  color: color/%d.png
targets: targets.yaml
)";

void write_frame(const std::filesystem::path& folder, const Arm& arm, const View& view, int frame) {
  const Scene scene(arm, frame);
  const Truth truth = cast_truth(scene, view);
  const std::string name = std::to_string(frame) + ".png";
  const auto depth = measure(truth, seed + static_cast<std::uint64_t>(frame));
  write_grey8(folder / "truth" / name, View::width, View::height, truth.mask);
  write_grey16(folder / "depth" / name, View::width, View::height, depth);
  write_rgb8(folder / "color" / name, View::width, View::height, shade_colours(scene, view));
}

void make(const std::filesystem::path& folder, int first, int last) {
  for (const char* part : {"truth", "depth", "color"})
    std::filesystem::create_directories(folder / part);
  const Arm arm;
  const View view;
  arm.write(folder / "arm_description");
  write_file(folder / "camera_info.yaml", camera_info());
  write_file(folder / "camera_pose.csv", camera_pose(view));
  write_file(folder / "joint_states.csv", joint_states());
  write_file(folder / "recording.yaml", recording);
  for (int frame = first; frame <= last; ++frame) write_frame(folder, arm, view, frame);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2 && argc != 4) {
    std::cerr << "usage: make_arm_over_table FOLDER [FIRST LAST]\n";
    return 2;
  }
  const int first = argc == 4 ? std::stoi(argv[2]) : 0;
  const int last = argc == 4 ? std::stoi(argv[3]) : Scene::frame_count - 1;
  if (first < 0 || last >= Scene::frame_count) {
    std::cerr << "frames are 0 to " << Scene::frame_count - 1 << '\n';
    return 2;
  }
  make(argv[1], first, last);
  return 0;
} catch (const std::exception& e) {
  std::cerr << e.what() << '\n';
  return 1;
}
