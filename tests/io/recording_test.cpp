// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"
#include "robots.hpp"

#include <io/files/csv.hpp>
#include <io/files/frame_reader.hpp>
#include <io/files/joint_file.hpp>
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

// A recording without images in a folder of its own.
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
  }

  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  Recording open(const std::string& yaml) const {
    folder_.write("recording.yaml", yaml);
    return Recording::open(folder_.path());
  }

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
};

/// tests/python/test_recorder.py and tests/apps/run_test.cpp have the others.
TEST_F(RecordingFolder, ReadsOptionalKeys) {
  const Recording recording = open(
      "robot:\n"
      "  urdf: arm.urdf\n"
      "  packages: {some_pkg: pkg}\n"
      "  ignore_links: ['tool*', base]\n"
      "  only_links: ['*']\n"
      "camera:\n"
      "  info: info.yaml\n"
      "  parent: lower\n"
      "  pose: pose.csv\n"
      "  front_min_width: 3\n"
      "  rectified: true\n"
      "frames:\n"
      "  joints: joints.csv\n"
      "  depth: depth/%04d.npy\n");
  EXPECT_EQ(recording.robots.at(0).options.packages.at("some_pkg"), file("pkg"));
  EXPECT_EQ(recording.robots.at(0).options.ignore_links,
            (std::vector<std::string>{"tool*", "base"}));
  EXPECT_EQ(recording.robots.at(0).options.only_links, std::vector<std::string>{"*"});
  EXPECT_EQ(recording.pipeline_config().rule.front_min_width, 3);
  EXPECT_TRUE(recording.camera.rectified);
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
      [&](const std::string& text) { return open(text); });
  EXPECT_HAS(test::refusal([&] { return Recording::open(file("nowhere")); }), "nowhere: ");
}

TEST_F(RecordingFolder, ReadsSeveralRobots) {
  const std::string two =
      "robots:\n"
      "  a: {urdf: arm.urdf, pose: [0, 1, 0, 0, 0, 0, 1]}\n"
      "  b: {urdf: arm.urdf, pose: [0, 0, 2, 0, 0, 1, 0], margins: {tool: 0.01}}\n";
  const auto with_robots = [&](const std::string& robots) {
    return replaced("robot:\n  urdf: arm.urdf\n", robots);
  };
  folder_.write("joints.csv",
                "frame,a/shoulder,a/elbow,b/shoulder,b/elbow\n"
                "5,0.1,0.2,,0.4\n7,0.1,0.2,0.3,0.4\n9,0.1,0.2,0.3\n");
  const Recording recording = open(with_robots(two));
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
       {with_robots("robots:\n  a: {urdf: arm.urdf, pose: [0, 0, 0, 0, 0, 0, 2]}\n"),
        ":2: robots.a.pose: "},
       {with("  urdf", "  pose: [0, 0, 0, 0, 0, 0, 1]"), ":3: robot.pose: is for several robots"}},
      [&](const std::string& text) { return open(text); });
}

class JointFile : public testing::Test {
 protected:
  std::vector<JointRow> read(const std::string& text) {
    return read_joint_file(folder_.write("joints.csv", text), robot_);
  }
  std::size_t variable(const std::string& name) { return robot_.find_variable(name).value(); }

  Robot robot_ = test::arm();
  test::TemporaryFolder folder_;
};

TEST_F(JointFile, ReadsColumnsInAnyOrderAndFramesInTheFilesOrder) {
  const auto rows = read(
      "\xEF\xBB\xBF"
      "frame,stamp, elbow ,finger_joint,shoulder\r\n"
      "7,1700000000123456789,0.25,9,1.5\r\n\r\n  \n000003,6,-0.5,,+2");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].index, 7);
  EXPECT_EQ(rows[0].stamp, 1700000000123456789) << "exact";
  EXPECT_EQ(rows[0].fault, "");
  EXPECT_EQ(rows[0].positions[variable("elbow")], 0.25);
  EXPECT_EQ(rows[0].positions[variable("shoulder")], 1.5);
  EXPECT_EQ(rows[1].index, 3);
  EXPECT_EQ(rows[1].positions[variable("elbow")], -0.5);
  EXPECT_EQ(rows[1].positions[variable("shoulder")], 2.0);
  EXPECT_EQ(read("frame,shoulder,elbow\n0,1,2\n")[0].stamp, std::nullopt);
}

TEST_F(JointFile, ReadsQuotedCells) {
  const auto rows =
      read("\"frame\",\"stamp\", \"elbow\" ,\"shoulder\"\n\"7\",\"5\",\"0.25\",\"1.5\"\r\n");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].index, 7);
  EXPECT_EQ(rows[0].stamp, 5);
  EXPECT_EQ(rows[0].positions[variable("elbow")], 0.25);
  const FrameTable table(
      folder_.write("t.csv", "frame,a,b\n0,\"x, \"\"y\"\"\",\"\"\n1,\"p\"q,\"r\"\n"));
  using Cells = std::vector<std::string_view>;
  EXPECT_EQ(table.rows()[0].cells, (Cells{"0", "x, \"y\"", ""}));
  EXPECT_EQ(table.rows()[1].cells, (Cells{"1", "\"p\"q", "r"})) << "no quoted cell";
}

TEST_F(JointFile, RefusesFilesItCannotBeSureOf) {
  const std::string header = "frame,shoulder,elbow\n";
  test::expect_refused({{"", "joints.csv: "},
                        {header, "no frames"},
                        {"shoulder,elbow\n1,2\n", ":1: "},
                        {"frame;shoulder;elbow\n0;1;2\n", "commas"},
                        {",frame,shoulder,elbow\n0,0,1,2\n", "index=False"},
                        {header + "0,1,2\n1,\"1\n\",2\n", ":3: a quote is not closed"},
                        {"frame,shoulder\n0,1\n", "'elbow'"},
                        {"frame,shoulder,elbw,elbow\n0,1,2,3\n", "'elbw'"},
                        {"frame,shoulder,elbow,flange\n0,1,2,3\n", "'flange'"},
                        {"frame,shoulder,elbow,\n0,1,2,\n", "''"},
                        {"frame,shoulder,elbow,shoulder\n0,1,2,3\n", "'shoulder' is there twice"},
                        {header + "0,1,2\n1,1,2\n0,1,2\n", ":4: frame 0"},
                        {"frame,stamp,shoulder,elbow\n0,0,1,2\n1,-5,1,2\n", ":3: stamp -5"},
                        {header + "-1,1,2\n", ":2: '-1'"},
                        {header + "1.0,1,2\n", ":2: '1.0'"},
                        {header + "9223372036854775808,1,2\n", "'9223372036854775808'"},
                        {header + "0,1,2\n9223372036854775807,1,2\n", ":3: '9223372036854775807'"}},
                       [&](const std::string& text) { read(text); });
}

TEST_F(JointFile, ABadCellLeavesTheOtherJointsOfItsRowKnown) {
  const auto rows = read("frame,shoulder,elbow\n0,0.5,\n1,x,0.25\n2,1,2,3\n");
  ASSERT_EQ(rows.size(), 3U);
  for (const auto& [row, unknown] :
       {std::pair(std::size_t{0}, "elbow"), {std::size_t{1}, "shoulder"}}) {
    EXPECT_EQ(rows[row].unknown, std::vector{variable(unknown)});
    EXPECT_NE(rows[row].fault.find(unknown), std::string::npos) << rows[row].fault;
  }
  EXPECT_EQ(rows[0].positions[variable("shoulder")], 0.5);
  EXPECT_TRUE(rows[2].unknown.empty() && rows[2].positions.empty()) << "too many cells";
}

}  // namespace
}  // namespace penumbra::io
