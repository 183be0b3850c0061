// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"
#include "robots.hpp"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include <io/files/frame_reader.hpp>
#include <io/files/png.hpp>
#include <io/files/recording.hpp>

namespace penumbra::io {
namespace {

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
  FrameReader reader() const { return {Recording::open(folder_.path()), test::arm()}; }

  // `minimal` with `line` below the line that starts with `after`.
  static std::string with(const std::string& after, const std::string& line) {
    std::string text = minimal;
    text.insert(text.find('\n', text.find(after)) + 1, line + "\n");
    return text;
  }
  // `minimal` with a body of these keys.
  static std::string attached(const std::string& keys) {
    return std::string(minimal) + "attached: [{name: part, link: hand, " + keys + "}]\n";
  }
  static std::string replaced(const std::string& from, const std::string& to) {
    return test::replaced(minimal, from, to);
  }

  test::TemporaryFolder folder_;
  Image<Rgb8> color_ = Image<Rgb8>(width, height, Rgb8{1, 2, 3});
};

TEST_F(RecordingFolder, OpensByFolderAndByFile) {
  for (const auto& path : {folder_.path(), file("recording.yaml")}) {
    const Recording recording = Recording::open(path);
    EXPECT_EQ(recording.file, file("recording.yaml"));
    EXPECT_EQ(recording.robots.at(0).urdf, file("arm.urdf"));
    EXPECT_EQ(recording.camera.camera.intrinsics, Intrinsics(8, 6, 9, 9, 3.5, 2.5));
    EXPECT_EQ(recording.camera.T_parent_camera->translation(), Eigen::Vector3d(0.5, 0, -1));
    EXPECT_EQ(recording.frames.depth.value().file(5), file("depth_5.png"));
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
  EXPECT_EQ(recording.robots.at(0).options.packages.at("some_pkg"), file("pkg"));
  EXPECT_EQ(recording.robots.at(0).options.geometry_of_links,
            (std::map<std::string, Geometry>{{"finger*", Geometry::visual},
                                             {"base", Geometry::collision}}));
  EXPECT_EQ(recording.robots.at(0).options.ignore_links,
            (std::vector<std::string>{"tool*", "base"}));
  EXPECT_EQ(recording.robots.at(0).options.margins,
            (std::map<std::string, double>{{"upper", 0.01}, {"f*", -0.002}}));
  ASSERT_EQ(recording.robots.at(0).options.extra.size(), 1U);
  EXPECT_EQ(recording.robots.at(0).options.extra[0].link, "lower");
  EXPECT_EQ(recording.robots.at(0).options.extra[0].mesh, file("arm.urdf"));
  const PipelineConfig config = recording.pipeline_config();
  EXPECT_EQ(config.rule.tolerance.a, 0.02);
  EXPECT_EQ(config.rule.tolerance.c, 0.01);
  EXPECT_EQ(config.rule.front_min_width, 3);
  EXPECT_EQ(config.camera_parent, "lower");
  ASSERT_TRUE(recording.camera.range);
  EXPECT_EQ(recording.camera.range->far, 4.0);
  EXPECT_EQ(recording.camera.camera.range.near, 0.3);
  EXPECT_TRUE(recording.camera.rectified);
  EXPECT_EQ(recording.camera.beyond, BeyondMeans::visible);
  EXPECT_FALSE(recording.camera.depth_along_ray);
  EXPECT_EQ(recording.frames.depth.value().file(5), file("depth/0005.npy"));
  EXPECT_FALSE(recording.frames.color);
  EXPECT_EQ(open(with("  urdf", "  geometry: visual")).robots.at(0).options.geometry,
            Geometry::visual);
}

TEST_F(RecordingFolder, NamesKeyAndLineOfEveryFault) {
  test::expect_refused(
      {{with("  parent", "  toleranc: [1, 2, 3]"), ":6: camera.toleranc: "},
       {with("  parent", "  depth_along: x"), ":6: camera.depth_along: "},
       {with("  urdf", "  color: red"), ":3: robot.color: "},
       {with("  joints", "  colour: x"), ":9: frames.colour: "},
       {std::string(minimal) + "scene: x\n", ":11: scene: "},
       {replaced("  urdf: arm.urdf\n", "  geometry: visual\n"), ":1: robot: key 'urdf'"},
       {replaced("  parent: base\n", ""), ":3: camera: key 'parent'"},
       {replaced("arm.urdf", "none.urdf"), ":2: robot.urdf: no file " + file("none.urdf").string()},
       {replaced("arm.urdf", "[a, b]"), ":2: robot.urdf: "},
       {replaced("pose.csv", "none.csv"), ":6: camera.pose: "},
       {replaced("info.yaml", "pkg"), ":4: camera.info: "},
       {replaced("joints.csv", "''"), ":8: frames.joints: "},
       {replaced("depth_%d.png", "depth_%s.png"), ":9: frames.depth: 'depth_%s.png'"},
       {replaced("color_%d.png", "color.png"), ":10: frames.color: 'color.png'"},
       {with("  urdf", "  packages: {a: nowhere}"), ":3: robot.packages.a: "},
       {with("  urdf", "  packages: [a]"), ":3: robot.packages: "},
       {with("  urdf", "  geometry: convex"), ":3: robot.geometry: "},
       {with("  urdf", "  geometry: {a: x}"), ":3: robot.geometry.a: "},
       {with("  urdf", "  ignore_links: base"), ":3: robot.ignore_links: "},
       {with("  urdf", "  margins: {a: wide}"), ":3: robot.margins.a: "},
       {with("  parent", "  tolerance: 0.01"), ":6: camera.tolerance: "},
       {with("  parent", "  front_min_width: 2.5"), ":6: camera.front_min_width: "},
       {with("  parent", "  front_min_width: 64"), "0 to 63"},
       {with("  parent", "  range: [3, 1]"), ":6: camera.range: "},
       {with("  parent", "  rectified: yes"), ":6: camera.rectified: "},
       {with("  parent", "  beyond: hidden"), ":6: camera.beyond: "},
       {with("  parent", "  depth_info: info.yaml"), ":3: camera: key 'depth_pose'"},
       {with("  parent", "  depth_pose: pose.csv"), ":3: camera: key 'depth_info'"},
       {std::string(minimal) + "targets: targets.yaml\n", ":11: targets: no file "},
       {attached("mesh: none.stl"), ":11: attached[0].mesh: no file "},
       {attached("box: [1, 1]"), ":11: attached[0].box: "},
       {attached("box: [1, 0, 1]"), ":11: attached[0].box: "},
       {attached("pose: [0, 0, 0, 0, 0, 0, 1]"), "needs a mesh"},
       {attached("box: [1, 1, 1], pose: [0, 0, 0, 0, 0, 0, 2]"), ":11: attached[0].pose: "},
       {attached("box: [1, 1, 1], frames: 3"), ":11: attached[0].frames: "},
       {attached("box: [1, 1, 1], frames: [9, 3]"), ":11: attached[0].frames: "},
       {attached("box: [1, 1, 1]}, {name: part, link: base, box: [1, 1, 1], frames: [6, 7]"),
        ":11: attached[1]: "},
       {with("  parent", "  parent: tool"), ":6: key 'parent'"},
       {"", ":1: "},
       {"text", ":1: "}},
      [&](const std::string& text) { static_cast<void>(open(text)); });
  EXPECT_HAS(test::refusal([&] { return Recording::open(file("nowhere")); }), "nowhere: ");
}

TEST_F(RecordingFolder, ReadsFrames) {
  const FrameReader frames = reader();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames.index(1), 7);
  for (const std::size_t i : {0U, 1U, 0U}) {
    const Frame frame = frames.read(i, true);
    EXPECT_EQ(frame.pose.status, FrameStatus::ok) << frame.pose.message;
    EXPECT_EQ(frame.pose.message + frame.source_message + frame.color_message, "");
    EXPECT_EQ(frame.index, i == 0 ? 5U : 7U);
    EXPECT_EQ(frame.stamp, i == 0 ? 100 : 200);
    EXPECT_EQ(frame.pose.positions, i == 0 ? (std::vector{0.1, 0.2}) : (std::vector{0.3, 0.4}));
    const auto view = std::get<ImageView<const std::uint16_t>>(frame.depth.view);
    ASSERT_EQ(view.width, width);
    ASSERT_EQ(view.height, height);
    EXPECT_EQ(view(3, 2), depth(i == 0 ? 5 : 7)(3, 2));
    EXPECT_EQ(frame.color.view(2, 2), (Rgb8{1, 2, 3}));
  }
  const Frame plain = frames.read(1, false);
  EXPECT_TRUE(plain.color.view.empty());
  EXPECT_EQ(plain.color_message, "");
}

TEST_F(RecordingFolder, DepthAlongTheRayBecomesZ) {
  write_yaml(with("  parent", "  depth_along: ray"));
  const Frame frame = reader().read(0, false);
  const auto view = std::get<ImageView<const float>>(frame.depth.view);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      EXPECT_NEAR(view(u, v),
                  0.001 * depth(5)(u, v) / std::hypot(1.0, (u - 3.5) / 9.0, (v - 2.5) / 9.0), 1e-6)
          << u << ' ' << v;
}

TEST_F(RecordingFolder, ReadsSeveralRobots) {
  const std::string two =
      "robots:\n"
      "  a: {urdf: arm.urdf, pose: [0, 1, 0, 0, 0, 0, 1]}\n"
      "  b: {urdf: arm.urdf, pose: [0, 0, 2, 0, 0, 1, 0], margins: {tool: 0.01}}\n";
  std::string many = "robots:\n";
  for (int i = 0; i < 1000; ++i)
    many += "  r" + std::to_string(i) + ": {urdf: arm.urdf, pose: [0, 0, 0, 0, 0, 0, 1]}\n";
  const auto with_robots = [&](const std::string& robots) {
    return replaced("robot:\n  urdf: arm.urdf\n", robots);
  };
  write_yaml(with_robots(two));
  folder_.write("joints.csv",
                "frame,a/shoulder,a/elbow,b/shoulder,b/elbow\n"
                "5,0.1,0.2,,0.4\n7,0.1,0.2,0.3,0.4\n9,0.1,0.2,0.3\n");
  const Recording recording = Recording::open(folder_.path());
  const Robot robot = recording.load_robot();
  EXPECT_EQ(robot.links().size(), 11U);
  EXPECT_EQ(recording.robot_options().margins, (std::map<std::string, double>{{"b/tool", 0.01}}));
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(robot.rest_positions(), poses);
  EXPECT_TRUE(poses[*robot.find_link("a/base")].translation().isApprox(Eigen::Vector3d(0, 1, 0)));
  EXPECT_TRUE(poses[*robot.find_link("b/base")].translation().isApprox(Eigen::Vector3d(0, 0, 2)));

  const FrameReader frames(recording, robot);
  Frame data = frames.read(0, false);
  EXPECT_EQ(data.pose.status, FrameStatus::ok);
  EXPECT_TRUE(data.pose.positions.empty()) << "not all are known";
  EXPECT_EQ(data.pose.T_root_link.size(), robot.links().size());
  EXPECT_EQ(data.pose.uncertain_links, (std::vector<std::size_t>{7, 8, 9, 10}))
      << "what b's shoulder moves";
  EXPECT_HAS(data.pose.uncertain_reason, "b/shoulder");
  data = frames.read(1, false);
  EXPECT_TRUE(data.pose.uncertain_links.empty());
  data = frames.read(2, false);
  EXPECT_EQ(data.pose.status, FrameStatus::missing_joints) << "too few cells";

  test::expect_refused(
      {{with_robots(two + "robot:\n  urdf: arm.urdf\n"), ":1: robots: stands beside 'robot'"},
       {with_robots("robots:\n  a: {urdf: arm.urdf}\n"), ":2: "},
       {with_robots("robots:\n  \"a\\e[31m\": {urdf: arm.urdf, pose: [0, 0, 0, 0, 0, 0, 1]}\n"),
        "control character"},
       {with_robots(many), ":1: robots: "},
       {with_robots("robots:\n  a: {urdf: arm.urdf, pose: [0, 0, 0, 0, 0, 0, 2]}\n"),
        ":2: robots.a.pose: "},
       {with("  urdf", "  pose: [0, 0, 0, 0, 0, 0, 1]"), ":3: robot.pose: is for several robots"}},
      [&](const std::string& text) { static_cast<void>(open(text)); });
}

TEST_F(RecordingFolder, SurvivesDamage) {
  test::read_damaged(minimal, 1000,
                     [&](const std::string& text) { static_cast<void>(open(text)); });
}

}  // namespace
}  // namespace penumbra::io
