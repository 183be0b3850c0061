// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"
#include "tiny_recording.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

/// A recording that is made faulty, and words that the one line on stderr must hold.
struct BadInput {
  const char* name;
  std::function<void(const fs::path&)> spoil;
  std::vector<std::string> words;
  std::vector<std::string> options = {};
};

std::ostream& operator<<(std::ostream& out, const BadInput& bad) { return out << bad.name; }

using Spoil = std::function<void(const fs::path&)>;

Spoil nothing() {
  return [](const fs::path&) {};
}
Spoil edit(const char* file, const char* from, const char* to) {
  return [=](const fs::path& folder) { edit_file(folder / file, from, to); };
}
Spoil replace(const char* file, const std::string& content) {
  return [=](const fs::path& folder) { write_file(folder / file, content); };
}
Spoil take_away(const char* file) {
  return [=](const fs::path& folder) { fs::remove(folder / file); };
}

template <typename T>
Spoil every_depth(int width, int height, T value) {
  return [=](const fs::path& folder) {
    const Image<T> image(width, height, value);
    for (const char* file : {"depth_0.png", "depth_1.png", "depth_2.png"})
      io::write_png(folder / file, image.view());
  };
}

std::string robot(const std::string& content) {
  return "<robot name=\"tiny\">" + content + "</robot>";
}
std::string joint(const std::string& parent, const std::string& child, const std::string& type) {
  return "<joint name=\"" + parent + "_" + child + "\" type=\"" + type + "\"><parent link=\"" +
         parent + "\"/><child link=\"" + child + "\"/></joint>";
}
std::string link(const std::string& name) { return "<link name=\"" + name + "\"/>"; }

std::string binary_stl(std::uint32_t triangles, std::size_t bytes) {
  std::string stl(84 + 50 * static_cast<std::size_t>(triangles), '\0');
  for (int i = 0; i < 4; ++i)
    stl[80 + static_cast<std::size_t>(i)] = static_cast<char>((triangles >> (8 * i)) & 255U);
  return stl.substr(0, bytes);
}

/// ASCII as a Windows editor saves it, with a byte order mark or without.
std::string utf16(const std::string& text, bool with_mark) {
  std::string bytes = with_mark ? "\xFF\xFE" : "";
  for (const char c : text) bytes.append({c, '\0'});
  return bytes;
}

std::vector<BadInput> bad_robots() {
  return {
      {"UrdfMissing", take_away("tiny.urdf"), {"tiny.urdf"}},
      {"UrdfEmpty", replace("tiny.urdf", ""), {"tiny.urdf"}},
      {"UrdfNoXml", replace("tiny.urdf", "robot: tiny\n"), {"tiny.urdf"}},
      {"UrdfCutOff",
       replace("tiny.urdf", "<robot name=\"tiny\"><link name=\"base\">"),
       {"tiny.urdf"}},
      {"UrdfInUtf16",
       replace("tiny.urdf", utf16("<robot name=\"tiny\"/>", true)),
       {"tiny.urdf", "UTF-16"}},
      {"UrdfXacro",
       replace("tiny.urdf",
               "<robot name=\"tiny\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">"
               "<xacro:include filename=\"a.xacro\"/><link name=\"base\"/></robot>"),
       {"tiny.urdf", "xacro"}},
      {"UrdfNoLinks", replace("tiny.urdf", robot("")), {"tiny.urdf", "link"}},
      {"UrdfTwoRoots",
       replace("tiny.urdf", robot(link("base") + link("other"))),
       {"tiny.urdf", "base", "other"}},
      {"UrdfCycle",
       replace("tiny.urdf", robot(link("base") + link("b") + link("c") + joint("b", "c", "fixed") +
                                  joint("c", "b", "fixed"))),
       {"tiny.urdf"}},
      {"UrdfUnknownJointType",
       edit("tiny.urdf", "prismatic", "spherical"),
       {"tiny.urdf", "spherical"}},
      {"UrdfNanOrigin",
       edit("tiny.urdf", "xyz=\"0 0 1\"", "xyz=\"0 nan 1\""),
       {"tiny.urdf", "nan"}},
      {"MeshMissing", take_away("board.stl"), {"board"}},
      {"MeshEmpty", replace("board.stl", ""), {"board.stl"}},
      {"MeshTruncated", replace("board.stl", binary_stl(12, 400)), {"board.stl"}},
      {"MeshCutInItsHeader", replace("board.stl", binary_stl(12, 83)), {"board.stl"}},
      {"MeshTextCutOff", replace("board.stl", board_stl().substr(0, 300)), {"board.stl"}},
      {"MeshOfNoTriangles", replace("board.stl", binary_stl(0, 84)), {"board.stl"}},
      {"MeshNanVertex", edit("board.stl", "vertex -0.2", "vertex nan"), {"board.stl"}},
      {"MeshHugeVertex", edit("board.stl", "vertex -0.2", "vertex 1e30"), {"board.stl"}},
  };
}

std::vector<BadInput> bad_recordings() {
  return {
      {"NoFolder", [](const fs::path& folder) { fs::remove_all(folder); }, {"recording"}},
      {"NoYaml", take_away("recording.yaml"), {"recording.yaml"}},
      {"YamlEmpty", replace("recording.yaml", ""), {"recording.yaml"}},
      {"YamlBroken", replace("recording.yaml", "robot: [\n"), {"recording.yaml"}},
      {"YamlUnknownKey", edit("recording.yaml", "  parent:", "  perent:"), {"perent"}},
      {"NoCameraInfo", take_away("camera_info.yaml"), {"camera_info.yaml"}},
      {"FocalLengthZero", edit("camera_info.yaml", "k: [60.0", "k: [0.0"), {"camera_info.yaml"}},
      {"FocalLengthNegative",
       edit("camera_info.yaml", "k: [60.0", "k: [-60.0"),
       {"camera_info.yaml"}},
      {"FocalLengthHuge", edit("camera_info.yaml", "k: [60.0", "k: [1e300"), {"camera_info.yaml"}},
      {"LensThatReachesNoPixel",
       edit("camera_info.yaml", "d: [0.0", "d: [-1e9"),
       {"camera_info.yaml", "reaches no pixel"}},
      {"UnknownDistortion", edit("camera_info.yaml", "plumb_bob", "fishy"), {"fishy"}},
      {"NearBeyondFar",
       edit("recording.yaml", "  parent:", "  range: [3.0, 0.5]\n  parent:"),
       {"range"}},
      {"PoseNotRigid", edit("camera_pose.csv", "1,0,0,0", "2,0,0,0"), {"camera_pose.csv"}},
      {"PoseFar",
       edit("camera_pose.csv", "1,0,0,0", "1,0,0,1e300"),
       {"camera_pose.csv", "1000 km"}},
      {"PoseNoNumber", edit("camera_pose.csv", "1,0,0,0", "one,0,0,0"), {"camera_pose.csv"}},
      {"PoseInUtf16",
       replace("camera_pose.csv", utf16("1,0,0,0\n0,1,0,0\n0,0,1,0\n0,0,0,1\n", false)),
       {"camera_pose.csv: is UTF-16", "UTF-8"}},
      {"ParentUnknown",
       edit("recording.yaml", "parent: base", "parent: bass"),
       {"recording.yaml", "bass"}},
      {"NothingDrawn",
       edit("recording.yaml", "  urdf: tiny.urdf", "  urdf: tiny.urdf\n  ignore_links: ['*']"),
       {"no link is drawn"}},
      {"RobotWithoutGeometry",
       edit("tiny.urdf",
            "<collision><geometry><mesh filename=\"board.stl\"/></geometry></collision>", ""),
       {"no link is drawn"}},
  };
}

/// Joint states and depth images.
std::vector<BadInput> bad_frames() {
  return {
      {"JointsMissing", take_away("joint_states.csv"), {"joint_states.csv"}},
      {"JointsEmpty", replace("joint_states.csv", ""), {"joint_states.csv"}},
      {"JointsNoRows", replace("joint_states.csv", "frame,slide\n"), {"joint_states.csv"}},
      {"JointLacking", replace("joint_states.csv", "frame\n0\n"), {"joint_states.csv", "slide"}},
      {"JointUnknown",
       replace("joint_states.csv", "frame,slide,elbow\n0,0,0\n"),
       {"joint_states.csv", "elbow"}},
      {"JointNoNumber",
       replace("joint_states.csv", "frame,slide\n0,far\n1,near\n"),
       {"joint_states.csv", "far"}},
      {"JointsWithZeroByte",
       replace("joint_states.csv", std::string("frame,slide\n0,0.1\n\0", 19)),
       {"joint_states.csv:3", "'?'"}},
      {"JointsWithForeignBytes",
       replace("joint_states.csv", "frame,slide\n0,0.1\xFF\x1B[31m\n"),
       {"'0.1??[31m'"}},
      {"JointsInUtf16",
       replace("joint_states.csv", utf16("frame,slide\n0,0.1\n", true)),
       {"joint_states.csv: is UTF-16", "UTF-8"}},
      {"JointNan", replace("joint_states.csv", "frame,slide\n0,nan\n"), {"joint_states.csv"}},
      {"DepthMissing",
       [](const fs::path& folder) {
         for (const char* file : {"depth_0.png", "depth_1.png", "depth_2.png"})
           fs::remove(folder / file);
       },
       {"missing_depth", "depth_0.png"}},
      {"DepthOfAnotherSize", every_depth<std::uint16_t>(65, 48, 900), {"bad_depth", "depth_0.png"}},
      {"WidthAndHeightSwapped",
       [](const fs::path& folder) {
         edit_file(folder / "camera_info.yaml", "width: 64\nheight: 48", "width: 48\nheight: 64");
         edit_file(folder / "recording.yaml", "frames:", "targets: targets.yaml\nframes:");
         write_file(folder / "targets.yaml", "targets:\n  - {name: a, box: [9, 9, 9, 9]}\n");
       },
       {"bad_depth in 3 of 3 frames", "48 x 64\n"}},
      {"DepthOf8Bit", every_depth<std::uint8_t>(64, 48, 90), {"bad_depth", "depth_0.png"}},
      {"ColorAsDepth", every_depth<io::Rgb8>(64, 48, {1, 2, 3}), {"bad_depth", "depth_0.png"}},
  };
}

std::vector<BadInput> bad_options() {
  return {
      {"RendererUnknown", nothing(), {"--renderer", "fast"}, {"--renderer", "fast"}},
      {"GeometryUnknown", nothing(), {"--geometry", "nice"}, {"--geometry", "nice"}},
      {"ToleranceOfTwo", nothing(), {"--tolerance", "0.1,0"}, {"--tolerance", "0.1,0"}},
      {"ToleranceText", nothing(), {"--tolerance", "a,b,c"}, {"--tolerance", "a,b,c"}},
      {"ToleranceNegative", nothing(), {"-1"}, {"--tolerance=-1,0,0"}},
      {"WidthNegative", nothing(), {"--front-min-width"}, {"--front-min-width=-1"}},
      {"LabelsUnknown", nothing(), {"--labels", "half"}, {"--labels", "half"}},
      {"ImageUnknown", nothing(), {"--image", "cooked"}, {"--image", "cooked"}},
      {"SaveUnknown", nothing(), {"--save", "video"}, {"--save", "labels,video"}},
      {"ThreadsZero", nothing(), {"--threads", "0"}, {"--threads", "0"}},
      {"ThreadsTooMany", nothing(), {"--threads", "1 to 512"}, {"--threads", "100000"}},
      {"ThreadsOfTheReference",
       nothing(),
       {"--threads 3", "one thread"},
       {"--renderer", "reference", "--threads", "3"}},
      {"ThreadsOfOpenGl",
       nothing(),
       {"--threads 2", "one thread"},
       {"--renderer", "gl", "--threads", "2"}},
      {"GlDeviceOfTheCpu", nothing(), {"--gl-device 0", "--renderer gl"}, {"--gl-device", "0"}},
      {"GlDeviceNegative", nothing(), {"--gl-device"}, {"--renderer", "gl", "--gl-device=-1"}},
      {"GlDeviceText", nothing(), {"--gl-device"}, {"--renderer", "gl", "--gl-device", "first"}},
      {"TargetsThatAreNotThere", nothing(), {"t.yaml"}, {"--targets", "t.yaml"}},
      {"TimeOffsetOfAFolder", nothing(), {"--time-offset", "bags"}, {"--time-offset=-0.1"}},
      {"WidthTooLarge", nothing(), {"--front-min-width", "0 to 63"}, {"--front-min-width", "64"}},
      {"FramesPastTheEnd", nothing(), {"--frames", "0 to 2"}, {"--frames", "1:4"}},
      {"FramesNone", nothing(), {"--frames"}, {"--frames", "2:2"}},
      {"FramesText", nothing(), {"--frames", "all"}, {"--frames", "all"}},
      {"UnknownOption", nothing(), {"--speed"}, {"--speed"}},
      {"TwoInputs", nothing(), {"another"}, {"another"}},
  };
}

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsOneClearLineAndStatus2) {
  const TemporaryFolder folder;
  const fs::path recording = folder.path() / "recording";
  fs::create_directory(recording);
  write_tiny_recording(recording);
  GetParam().spoil(recording);
  std::vector<std::string> arguments = {"run", recording, "-o", folder.path() / "out"};
  arguments.insert(arguments.end(), GetParam().options.begin(), GetParam().options.end());

  const Outcome outcome = penumbra(arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  for (const std::string& word : GetParam().words)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in: " << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(Robot, BadInputTest, testing::ValuesIn(bad_robots()), name_of);
INSTANTIATE_TEST_SUITE_P(Recording, BadInputTest, testing::ValuesIn(bad_recordings()), name_of);
INSTANTIATE_TEST_SUITE_P(Frame, BadInputTest, testing::ValuesIn(bad_frames()), name_of);
INSTANTIATE_TEST_SUITE_P(Option, BadInputTest, testing::ValuesIn(bad_options()), name_of);

TEST(BadCommandLine, IsOneLineAndStatus2) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> lines = {
      {{}, "run, tune, render, inspect, doctor, simulate, topics, play, live or view"},
      {{"walk"}, "walk"},
      {{"run"}, "INPUT"},
      {{"run", "x.mcap", "-o", "out"}, "x.mcap"},
      {{"run", "/etc/passwd", "-o", "out"}, "is neither a recording"},
      {{"render"}, "--robot"},
      {{"inspect"}, "URDF"},
      {{"inspect", "nowhere.urdf"}, "nowhere.urdf"},
      {{"run", "x.mcap", "-o", "out", "--package", "name=nowhere"}, "a folder that exists"},
      {{"run", "x.mcap", "-o", "out", "--package", "n=/", "--package", "n=/tmp"},
       "--package: 'n=/tmp' is not the only one of n"},
      {{"run", "recording", "-o", ""}, "-o,--output: '' is not a path"},
      {{"run", "", "-o", "out"}, "INPUT: '' is not a path"},
      {{"render", "--robot", "x.urdf", "--camera", "c.yaml", "--pose", "p.csv", "-o", ""},
       "-o,--output: '' is not a path"},
      {{"inspect", ""}, "URDF: '' is not a path"},
      {{"walk"}, "(penumbra --help tells the options)"},
      {{"run", "recording", "-o", "out", "--speed"}, "(penumbra run --help tells the options)"},
      {{"render"}, "(penumbra render --help tells the options)"}};
  for (const auto& [line, word] : lines) {
    const Outcome outcome = penumbra(line);
    EXPECT_EQ(outcome.status, 2) << testing::PrintToString(line) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in: " << outcome.err;
  }
}

}  // namespace
}  // namespace penumbra::test
