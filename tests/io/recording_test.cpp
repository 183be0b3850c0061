// SPDX-License-Identifier: Apache-2.0
#include "../support/data.hpp"
#include "../support/random.hpp"
#include "files.hpp"
#include "robots.hpp"

#include <random>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include <io/files/frame_reader.hpp>
#include <io/files/npy.hpp>
#include <io/files/recording.hpp>

namespace penumbra::io {
namespace {

using test::input_error;

constexpr const char* minimal =
    "robot:\n"
    "  urdf: arm.urdf\n"
    "camera:\n"
    "  info: info.yaml\n"
    "  parent: base\n"
    "  pose: pose.csv\n"
    "frames:\n"
    "  joints: joints.csv\n"
    "  depth: depth_%d.png\n"
    "  color: color_%d.png\n";

constexpr int width = 8;
constexpr int height = 6;

// A recording of frames 5 and 7 in a folder of its own.
class RecordingFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("arm.urdf", test::arm_urdf);
    folder_.write("info.yaml",
                  "width: 8\nheight: 6\ndistortion_model: plumb_bob\nd: [0, 0, 0, 0, 0]\n"
                  "k: [9, 0, 3.5, 0, 9, 2.5, 0, 0, 1]\n"
                  "p: [9, 0, 3.5, 0, 0, 9, 2.5, 0, 0, 0, 1, 0]\n"
                  "r: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n");
    folder_.write("pose.csv", "1,0,0,0.5\n0,1,0,0\n0,0,1,-1\n0,0,0,1\n");
    folder_.write("joints.csv", "frame,stamp,shoulder,elbow\n5,100,0.1,0.2\n7,200,0.3,0.4\n");
    folder_.write("pkg/x", "");
    for (const int i : {5, 7}) {
      write_png(file("depth_" + std::to_string(i) + ".png"), depth(i).view());
      write_png(file("color_" + std::to_string(i) + ".png"), std::as_const(color_).view());
    }
    write_yaml(minimal);
  }

  static Image<std::uint16_t> depth(int i) {
    Image<std::uint16_t> image(width, height);
    for (std::size_t p = 0; p < image.size(); ++p)
      image.data()[p] = static_cast<std::uint16_t>(100 * i + static_cast<int>(p));
    return image;
  }

  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  void write_yaml(const std::string& text) const { folder_.write("recording.yaml", text); }
  Recording open(const std::string& yaml) const {
    write_yaml(yaml);
    return Recording::open(folder_.path());
  }
  std::string fault(const std::string& yaml) const {
    return input_error([&] { static_cast<void>(open(yaml)); });
  }
  FrameReader reader() const { return {Recording::open(folder_.path()), test::arm()}; }

  // `minimal` with `line` below the line that starts with `after`.
  static std::string with(const std::string& after, const std::string& line) {
    std::string text = minimal;
    text.insert(text.find('\n', text.find(after)) + 1, line + "\n");
    return text;
  }
  static std::string replaced(const std::string& from, const std::string& to) {
    std::string text = minimal;
    return text.replace(text.find(from), from.size(), to);
  }

  test::TemporaryFolder folder_;
  Image<Rgb8> color_ = Image<Rgb8>(width, height, Rgb8{1, 2, 3});
};

TEST_F(RecordingFolder, OpensByFolderAndByFile) {
  for (const auto& path : {folder_.path(), file("recording.yaml")}) {
    const Recording recording = Recording::open(path);
    EXPECT_EQ(recording.file, file("recording.yaml"));
    EXPECT_EQ(recording.urdf, file("arm.urdf"));
    EXPECT_EQ(recording.robot.geometry, Geometry::collision);
    EXPECT_EQ(recording.camera.camera.intrinsics, Intrinsics(8, 6, 9, 9, 3.5, 2.5));
    EXPECT_EQ(recording.camera.parent, "base");
    EXPECT_EQ(recording.camera.T_parent_camera.translation(), Eigen::Vector3d(0.5, 0, -1));
    EXPECT_FALSE(recording.camera.rectified);
    EXPECT_FALSE(recording.camera.tolerance || recording.camera.front_min_width ||
                 recording.camera.range || recording.camera.beyond);
    EXPECT_EQ(recording.pipeline_config().rule.tolerance.a, LabelRule{}.tolerance.a);
    EXPECT_EQ(recording.frames.depth.file(5), file("depth_5.png"));
    EXPECT_EQ(recording.frames.color.value().file(5), file("color_5.png"));
  }
}

TEST_F(RecordingFolder, ReadsEveryOptionalKey) {
  const Recording recording = open(
      "robot:\n"
      "  urdf: arm.urdf\n"
      "  packages: {some_pkg: pkg}\n"
      "  geometry: {'finger*': visual, base: collision}\n"
      "  ignore_links: ['tool*', base]\n"
      "  only_links: ['*']\n"
      "  margins: {upper: 0.01, 'f*': -0.002}\n"
      "  extra: [{link: lower, mesh: arm.urdf}]\n"
      "camera:\n"
      "  info: info.yaml\n"
      "  parent: lower\n"
      "  pose: pose.csv\n"
      "  tolerance: [0.02, 0, 0.01]\n"
      "  front_min_width: 3\n"
      "  range: [0.3, 4]\n"
      "  rectified: true\n"
      "  beyond: visible\n"
      "frames:\n"
      "  joints: joints.csv\n"
      "  depth: depth/%04d.npy\n");
  EXPECT_EQ(recording.robot.packages.at("some_pkg"), file("pkg"));
  EXPECT_EQ(recording.robot.geometry_of_links,
            (std::map<std::string, Geometry>{{"finger*", Geometry::visual},
                                             {"base", Geometry::collision}}));
  EXPECT_EQ(recording.robot.ignore_links, (std::vector<std::string>{"tool*", "base"}));
  EXPECT_EQ(recording.robot.only_links, (std::vector<std::string>{"*"}));
  EXPECT_EQ(recording.robot.margins,
            (std::map<std::string, double>{{"upper", 0.01}, {"f*", -0.002}}));
  ASSERT_EQ(recording.robot.extra.size(), 1U);
  EXPECT_EQ(recording.robot.extra[0].link, "lower");
  EXPECT_EQ(recording.robot.extra[0].mesh, file("arm.urdf"));
  EXPECT_EQ(recording.camera.parent, "lower");
  ASSERT_TRUE(recording.camera.tolerance);
  EXPECT_EQ(recording.camera.tolerance->a, 0.02);
  EXPECT_EQ(recording.camera.tolerance->c, 0.01);
  EXPECT_EQ(recording.camera.front_min_width, 3);
  const PipelineConfig config = recording.pipeline_config();
  EXPECT_EQ(config.rule.tolerance.a, 0.02);
  EXPECT_EQ(config.rule.tolerance.c, 0.01);
  EXPECT_EQ(config.rule.front_min_width, 3);
  EXPECT_EQ(config.camera_parent, "lower");
  EXPECT_TRUE(config.T_parent_camera.isApprox(recording.camera.T_parent_camera, 0.0));
  ASSERT_TRUE(recording.camera.range);
  EXPECT_EQ(recording.camera.range->far, 4.0);
  EXPECT_EQ(recording.camera.camera.range.near, 0.3);
  EXPECT_TRUE(recording.camera.rectified);
  EXPECT_EQ(recording.camera.beyond, BeyondMeans::visible);
  EXPECT_EQ(recording.frames.depth.file(5), file("depth/0005.npy"));
  EXPECT_FALSE(recording.frames.color);
  EXPECT_EQ(open(with("  urdf", "  geometry: visual")).robot.geometry, Geometry::visual);
}

TEST_F(RecordingFolder, NamesKeyAndLineOfEveryFault) {
  const std::string yaml = file("recording.yaml").string();
  const std::vector<std::pair<std::string, std::string>> cases = {
      {with("  parent", "  toleranc: [1, 2, 3]"),
       ":6: camera.toleranc: unknown key; near are: tolerance"},
      {with("  urdf", "  color: red"), ":3: robot.color: unknown key; known are: urdf"},
      {with("  joints", "  colour: x"), ":9: frames.colour: unknown key"},
      {std::string(minimal) + "scene: x\n", ":11: scene: unknown key; known are: robot"},
      {replaced("  urdf: arm.urdf\n", "  geometry: visual\n"), ":1: robot: key 'urdf' is missing"},
      {replaced("  parent: base\n", ""), ":3: camera: key 'parent' is missing"},
      {replaced("  depth: depth_%d.png\n", ""), ":7: frames: key 'depth' is missing"},
      {replaced("arm.urdf", "none.urdf"), ":2: robot.urdf: no file " + file("none.urdf").string()},
      {replaced("arm.urdf", "[a, b]"), ":2: robot.urdf: is a list; a text is wanted"},
      {replaced("pose.csv", "none.csv"), ":6: camera.pose: no file"},
      {replaced("info.yaml", "pkg"), ":4: camera.info: no file"},
      {replaced("joints.csv", "''"), ":8: frames.joints: is ''; a text is wanted"},
      {replaced("depth_%d.png", "depth_%s.png"), ":9: frames.depth: 'depth_%s.png': exactly one"},
      {replaced("color_%d.png", "color.png"), ":10: frames.color: 'color.png': exactly one"},
      {with("  urdf", "  packages: {a: nowhere}"), ":3: robot.packages.a: no folder"},
      {with("  urdf", "  packages: [a]"), ":3: robot.packages: is a list"},
      {with("  urdf", "  geometry: convex"),
       ":3: robot.geometry: is 'convex'; collision or visual"},
      {with("  urdf", "  geometry: {a: x}"), ":3: robot.geometry.a: is 'x'"},
      {with("  urdf", "  ignore_links: base"), ":3: robot.ignore_links: is 'base'; a list"},
      {with("  urdf", "  margins: {a: wide}"), ":3: robot.margins.a: is 'wide'; a finite number"},
      {with("  parent", "  tolerance: 0.01"), ":6: camera.tolerance: is '0.01'; a list"},
      {with("  parent", "  tolerance: [0.01, 0]"), ":6: camera.tolerance: has 2 values; 3"},
      {with("  parent", "  tolerance: [-0.01, 0, 0]"), ":6: camera.tolerance: "},
      {with("  parent", "  front_min_width: 2.5"), ":6: camera.front_min_width: is '2.5'; a whole"},
      {with("  parent", "  front_min_width: 64"), ":6: camera.front_min_width: is 64; 0 to 63"},
      {with("  parent", "  front_min_width: -1"), ":6: camera.front_min_width: is -1; 0 to 63"},
      {with("  parent", "  range: [3, 1]"), ":6: camera.range: "},
      {with("  parent", "  range: [.nan, 1]"), ":6: camera.range[0]: is '.nan'"},
      {with("  parent", "  rectified: yes"), ":6: camera.rectified: is 'yes'; true or false"},
      {with("  parent", "  beyond: hidden"), ":6: camera.beyond: is 'hidden'; occluded or visible"},
      {with("  parent", "  depth_info: info.yaml"),
       ":6: camera.depth_info: depth_info and depth_pose belong together"},
      {with("  parent", "  depth_pose: pose.csv\n  depth_info: info.yaml"),
       "a depth camera of its own is not supported yet"},
      {std::string(minimal) + "targets: targets.yaml\n", ":11: targets: no file "},
      {with("  parent", "  parent: tool"), ":6: key 'parent' is there already, in line 5"},
      {"", ":1: is empty"},
      {"text", ":1: is 'text'; keys with values are wanted"},
  };
  for (const auto& [text, told] : cases) {
    const std::string message = fault(text);
    EXPECT_TRUE(message.starts_with(yaml + ":")) << message;
    EXPECT_HAS(message, told);
  }
}

TEST_F(RecordingFolder, NamesTheFaultyFile) {
  folder_.write("pose.csv", "2,0,0,0\n0,1,0,0\n0,0,1,0\n0,0,0,1\n");
  EXPECT_HAS(fault(minimal), "pose.csv: is no rigid transform");
  EXPECT_HAS(input_error([&] { static_cast<void>(Recording::open(file("nowhere"))); }),
             "nowhere: cannot be read: No such file or directory");
  EXPECT_HAS(input_error([&] { static_cast<void>(Recording::open(file("pkg"))); }),
             "pkg/recording.yaml: cannot be read");
}

TEST_F(RecordingFolder, ReadsFrames) {
  const FrameReader frames = reader();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames.index(1), 7);
  FrameData frame;
  for (const std::size_t i : {0U, 1U, 0U}) {
    frames.read(i, true, frame);
    EXPECT_EQ(frame.status, FrameStatus::ok) << frame.message;
    EXPECT_EQ(frame.message + frame.color_message, "");
    EXPECT_EQ(frame.index, i == 0 ? 5 : 7);
    EXPECT_EQ(frame.stamp, i == 0 ? 100 : 200);
    EXPECT_EQ(frame.positions, i == 0 ? (std::vector{0.1, 0.2}) : (std::vector{0.3, 0.4}));
    const auto view = std::get<ImageView<const std::uint16_t>>(frame.depth_view());
    ASSERT_EQ(view.width, width);
    ASSERT_EQ(view.height, height);
    EXPECT_EQ(view(3, 2), depth(i == 0 ? 5 : 7)(3, 2));
    EXPECT_EQ(frame.color(2, 2), (Rgb8{1, 2, 3}));
  }
  frames.read(1, false, frame);
  EXPECT_TRUE(frame.color.empty());
  EXPECT_EQ(frame.color_message, "");
}

TEST_F(RecordingFolder, DepthImagesWithoutARowAreFramesToo) {
  for (const int i : {0, 6, 9})
    write_png(file("depth_" + std::to_string(i) + ".png"), depth(i).view());
  folder_.write("joints.csv", "frame,shoulder,elbow\n7,1,2\n5,3,4\n");
  const FrameReader frames = reader();
  std::vector<std::int64_t> indices;
  FrameData frame;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    indices.push_back(frames.index(i));
    frames.read(i, false, frame);
    EXPECT_EQ(frame.index, frames.index(i));
    if (frame.index == 5 || frame.index == 7) {
      EXPECT_EQ(frame.status, FrameStatus::ok) << frame.message;
      continue;
    }
    EXPECT_EQ(frame.status, FrameStatus::missing_joints);
    EXPECT_EQ(frame.message,
              file("joints.csv").string() + " has no row for frame " + std::to_string(frame.index));
    EXPECT_TRUE(frame.positions.empty());
    EXPECT_EQ(frame.stamp, std::nullopt);
    const auto view = std::get<ImageView<const std::uint16_t>>(frame.depth_view());
    EXPECT_EQ(view(3, 2), depth(static_cast<int>(frame.index))(3, 2));
  }
  EXPECT_EQ(indices, (std::vector<std::int64_t>{0, 6, 7, 5, 9})) << "the file's order stays";
}

TEST_F(RecordingFolder, ReadsFramesFromSeveralThreads) {
  const FrameReader frames = reader();
  const auto work = [&](std::size_t first) {
    FrameData frame;
    for (std::size_t round = 0; round < 20; ++round) {
      const std::size_t i = (first + round) % 2;
      frames.read(i, true, frame);
      EXPECT_EQ(frame.status, FrameStatus::ok) << frame.message;
      EXPECT_EQ(frame.positions, i == 0 ? (std::vector{0.1, 0.2}) : (std::vector{0.3, 0.4}));
      const auto view = std::get<ImageView<const std::uint16_t>>(frame.depth_view());
      EXPECT_EQ(view(7, 5), depth(i == 0 ? 5 : 7)(7, 5));
      EXPECT_EQ(frame.color(2, 2), (Rgb8{1, 2, 3}));
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i) threads.emplace_back(work, i);
  for (std::thread& thread : threads) thread.join();
}

TEST_F(RecordingFolder, KeepsBuffersFromFrameToFrame) {
  const FrameReader frames = reader();
  FrameData frame;
  frames.read(0, true, frame);
  const auto* depth_before = std::get<Image<std::uint16_t>>(frame.depth).data();
  const Rgb8* color_before = frame.color.data();
  const double* positions_before = frame.positions.data();
  frames.read(1, true, frame);
  EXPECT_EQ(std::get<Image<std::uint16_t>>(frame.depth).data(), depth_before);
  EXPECT_EQ(frame.color.data(), color_before);
  EXPECT_EQ(frame.positions.data(), positions_before);
}

TEST_F(RecordingFolder, ReadsDepthInMetres) {
  Image<float> metres(width, height, 1.25F);
  write_npy(file("z_05.npy"), std::as_const(metres).view());
  write_yaml(replaced("depth_%d.png", "z_%02d.npy"));
  const FrameReader frames = reader();
  FrameData frame;
  frames.read(0, false, frame);
  ASSERT_EQ(frame.status, FrameStatus::ok) << frame.message;
  EXPECT_EQ(std::get<ImageView<const float>>(frame.depth_view())(7, 5), 1.25F);
  frames.read(1, false, frame);
  EXPECT_EQ(frame.status, FrameStatus::missing_depth);
}

TEST_F(RecordingFolder, TellsFaultsOfAFrameInItsStatus) {
  FrameData frame;
  const auto read = [&](bool with_color = false) {
    reader().read(0, with_color, frame);
    return frame.status;
  };
  const auto is_empty = [&] {
    return std::visit([](const auto& view) { return view.empty(); }, frame.depth_view());
  };
  const std::string depth_file = file("depth_5.png").string();

  write_png(depth_file, Image<std::uint16_t>(height, width, 1).view());
  EXPECT_EQ(read(), FrameStatus::bad_depth);
  EXPECT_EQ(frame.message, depth_file + ": has 6 x 8 pixels; the camera has 8 x 6");
  EXPECT_TRUE(is_empty());

  write_png(depth_file, Image<std::uint8_t>(width, height, 1).view());
  EXPECT_EQ(read(), FrameStatus::bad_depth);
  EXPECT_EQ(frame.message, depth_file + ": is 8-bit grey; 16-bit grey is wanted");

  write_png(depth_file, std::as_const(color_).view());
  EXPECT_EQ(read(), FrameStatus::bad_depth);
  EXPECT_EQ(frame.message, depth_file + ": is 8-bit RGB; 16-bit grey is wanted");

  folder_.write("depth_5.png", "text");
  EXPECT_EQ(read(), FrameStatus::bad_depth);

  std::filesystem::remove(depth_file);
  EXPECT_EQ(read(), FrameStatus::missing_depth);
  EXPECT_HAS(frame.message, "depth_5.png: cannot be read: No such file or directory");

  folder_.write("joints.csv", "frame,shoulder,elbow\n5,,2\n");
  EXPECT_EQ(read(), FrameStatus::missing_joints);
  EXPECT_HAS(frame.message, "joints.csv:2: frame 5: column 'shoulder' is empty; ");
  EXPECT_HAS(frame.message, "depth_5.png: cannot be read");
  EXPECT_TRUE(frame.positions.empty());

  write_png(depth_file, depth(5).view());
  EXPECT_EQ(read(), FrameStatus::missing_joints);
  EXPECT_FALSE(is_empty());

  folder_.write("joints.csv", "frame,shoulder,elbow\n5,1,2\n");
  write_png(file("color_5.png"), Image<Rgb8>(3, 3).view());
  EXPECT_EQ(read(true), FrameStatus::ok);
  EXPECT_HAS(frame.color_message, "color_5.png: has 3 x 3 pixels; the camera has 8 x 6");
  EXPECT_TRUE(frame.color.empty());
}

TEST_F(RecordingFolder, SurvivesDamage) {
  std::mt19937_64 random = test::seeded_random(1);
  const std::string whole = minimal;
  for (std::size_t length = 0; length < whole.size(); ++length)
    test::only_input_errors([&] { static_cast<void>(open(whole.substr(0, length))); });
  for (int i = 0; i < 1000; ++i) {
    std::string damaged = whole;
    for (int n = 0; n < 1 + i % 3; ++n)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    test::only_input_errors([&] { static_cast<void>(open(damaged)); });
  }
}

TEST(RealRecording, IsReadWhole) {
  PENUMBRA_REQUIRE_DATA();
  const Recording recording = Recording::open(test::data_folder() / "xarm7_realsense");
  const Robot robot = Robot::load(recording.urdf, recording.robot);
  const FrameReader frames(recording, robot);
  ASSERT_EQ(frames.size(), 10U);
  FrameData frame;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames.read(i, true, frame);
    EXPECT_EQ(frame.status, FrameStatus::ok) << frame.message;
    EXPECT_EQ(frame.index, static_cast<std::int64_t>(i));
    EXPECT_EQ(frame.stamp, std::nullopt);
    EXPECT_EQ(frame.positions.size(), 7U);
    EXPECT_EQ(frame.color.width(), 1280);
  }
  EXPECT_DOUBLE_EQ(frame.positions[robot.find_variable("joint2").value()], -0.4629654884338379);
}

}  // namespace
}  // namespace penumbra::io
