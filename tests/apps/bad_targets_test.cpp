// SPDX-License-Identifier: Apache-2.0
// What is wrong in a targets.yaml ends a run with status 2 and one line that says where.
#include "program.hpp"
#include "tiny_recording.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::test {
namespace {

struct BadTargets {
  const char* name;
  std::string text;                ///< the entry of target `a` without its name
  std::vector<std::string> words;  ///< which the line holds
};

std::ostream& operator<<(std::ostream& out, const BadTargets& bad) { return out << bad.name; }

std::vector<BadTargets> bad_regions() {
  return {
      {"BoxOfNoArea", "box: [1, 2, 0, 4]\n", {":3: targets[0].box", "area"}},
      {"BoxOfNegativeWidth", "box: [1, 2, -3, 4]\n", {":3: targets[0].box", "area"}},
      {"BoxWithNan", "box: [1, .nan, 3, 4]\n", {":3: targets[0].box", "finite"}},
      {"BoxTooFarOut", "box: [1e300, 2, 3, 4]\n", {":3: targets[0].box", "far out"}},
      {"BoxTooShort", "box: [1, 2, 3]\n", {":3: targets[0].box", "width, height"}},
      {"PolygonOfNoAreaInAFrame",
       "polygon:\n    frames:\n      0: [[1, 1], [20, 1], [20, 20]]\n"
       "      1: [[1, 1], [20, 20], [9, 9]]\n",
       {":6: targets[0].polygon.frames.1", "area"}},
      {"PolygonOfNoArea",
       "polygon: [[1, 1], [9, 9], [20, 20]]\n",
       {":3: targets[0].polygon", "area"}},
      {"PolygonOfTwoCorners", "polygon: [[1, 1], [2, 2]]\n", {":3: ", "3 corners"}},
      {"PolygonWithInfinity", "polygon: [[1, .inf], [2, 2], [3, 1]]\n", {":3: ", "finite"}},
      {"MaskMissing", "mask: no.png\n", {":3: targets[0].mask", "no.png"}},
      {"MaskOfAnotherSize", "mask: small.png\n", {":3: targets[0].mask", "7 x 5", "64 x 48"}},
      {"MaskOfNoPixel", "mask: empty.png\n", {":3: targets[0].mask", "without any pixel"}},
      {"MasksMissing", "mask: {files: m%d.png}\n", {":3: targets[0].mask.files", "no file"}},
      {"MaskIsColour", "mask: color_0.png\n", {":3: targets[0].mask", "color_0.png"}},
      {"RunLengthsOfAnotherSize",
       "rle: {size: [64, 48], counts: [3072]}\n",
       {":3: targets[0].rle", "another size"}},
      {"RunLengthsThatEndEarly", "rle: {size: [48, 64], counts: [5]}\n", {":3: ", "add up to 5"}},
      {"RunLengthsOfNoPixel",
       "rle: {size: [48, 64], counts: [3072]}\n",
       {":3: targets[0].rle", "without any pixel"}},
  };
}

std::vector<BadTargets> bad_objects() {
  const std::string solid = "\n  size: [0.1, 0.1, 0.1]\n";
  return {
      {"KeypointOfRadiusZero", "keypoint: [5, 5]\n  radius: 0\n", {":4: targets[0].radius"}},
      {"KeypointTooLarge", "keypoint: [5, 5]\n  radius: .inf\n", {":4: targets[0].radius"}},
      {"KeypointFileMissing", "keypoint: {csv: no.csv}\n", {"no.csv"}},
      {"KeypointFileOfOtherColumns",
       "keypoint: {csv: odd.csv}\n",
       {"odd.csv:1", "'v'", "frame and then, in any order"}},
      {"KeypointFileWithAFrameTwice", "keypoint: {csv: twice.csv}\n", {"twice.csv:3", "frame 0"}},
      {"QuaternionZero",
       "box3d: [0, 0, 1, 0, 0, 0, 0]" + solid,
       {":3: targets[0].box3d", "quaternion"}},
      {"QuaternionNotUnit",
       "box3d: [0, 0, 1, 0, 0, 0.5, 1]" + solid,
       {":3: targets[0].box3d", "quaternion", "length 1"}},
      {"SizeZero", "box3d: [0, 0, 1, 0, 0, 0, 1]\n  size: [0.1, 0, 0.1]\n", {":4: ", "size"}},
      {"PoseWithNan", "box3d: [0, 0, .nan, 0, 0, 0, 1]" + solid, {":3: ", "finite"}},
      {"EstimateQuaternionZero",
       "keypoint: [5, 5]\n  handling: pose\n  estimate: {pose: [0, 0, 1, 0, 0, 0, 0]}\n",
       {":5: targets[0].estimate", "quaternion"}},
      {"PointWithNan", "point: [0, .nan, 1]\n", {":3: targets[0].point", "finite"}},
      {"LinkUnknown", "point: [0, 0, 1]\n  link: bord\n", {":4: targets[0].link", "base, board"}},
      {"MeshTooLarge",
       "mesh: [0, 0, 1, 0, 0, 0, 1]\n  file: solid.obj\n  scale: 1e30\n",
       {":5: targets[0].scale", "1e6 m"}},
      {"MeshTooSmall",
       "mesh: [0, 0, 1, 0, 0, 0, 1]\n  file: solid.obj\n  scale: 1e-30\n",
       {":5: targets[0].scale", "1e-6"}},
      {"MeshBeyondNumbers",
       "mesh: [0, 0, 1, 0, 0, 0, 1]\n  file: solid.obj\n  scale: 1e300\n",
       {":5: targets[0].scale", "32 bits"}},
      {"KeypointFileWithoutFrames",
       "keypoint: {csv: late.csv}\n",
       {"late.csv:1", "frame and then, in any order"}},
      {"EstimateInTheCamera",
       "keypoint: [5, 5]\n  handling: point\n  estimate: {point: [0, 0, 0]}\n",
       {":5: targets[0].estimate", "from the camera"}},
      {"MeshMissing", "mesh: [0, 0, 1, 0, 0, 0, 1]\n  file: no.stl\n", {"no.stl"}},
      {"KeyUnknown", "box: [1, 2, 3, 4]\n  extend: modal\n", {":4: targets[0].extend", "extent"}},
      {"KindUnknown", "circle: [1, 2, 3]\n", {":2: targets[0]", "box, polygon"}},
      {"KindsTwo", "box: [1, 2, 3, 4]\n  point: [0, 0, 1]\n", {"targets[0]", "point"}},
      {"NameTwice", "box: [1, 2, 3, 4]\n- name: a\n  box: [1, 2, 3, 4]\n", {":4: ", "'a'"}},
  };
}

std::vector<BadTargets> bad_settings() {
  const std::string solid = "\n  size: [0.1, 0.1, 0.1]\n";
  return {
      {"FrameOfAnother",
       "box: [1, 2, 3, 4]\n  frame_id: other\n",
       {":4: targets[0].frame_id", "'other'", "the camera's"}},
      {"DepthNegative",
       "box: [1, 2, 3, 4]\n  expected_depth: -1\n",
       {":4: targets[0].expected_depth"}},
      {"MarginNegative", "box: [1, 2, 3, 4]\n  depth_margin: -1\n", {":4: ", "depth_margin"}},
      {"ThresholdsSwapped",
       "box: [1, 2, 3, 4]\n  thresholds: {partial_enter: 0.1, partial_leave: 0.2}\n",
       {":4: targets[0].thresholds", "0.2"}},
      {"HandlingUnknown", "box: [1, 2, 3, 4]\n  handling: hold\n", {":4: ", "'hold'"}},
      {"PoseOfARegion",
       "box: [1, 2, 3, 4]\n  handling: pose\n",
       {":4: targets[0].handling", "point"}},
      {"PoseOfAKeypoint",
       "keypoint: [5, 5]\n  handling: {pose: {motion: still}}\n",
       {":4: targets[0].handling", "point"}},
      {"PoseOfAPoint", "point: [0, 0, 1]\n  handling: pose\n", {":4: targets[0].handling"}},
      {"PoseOfAPointsEstimate",
       "box3d: [0, 0, 1, 0, 0, 0, 1]" + solid +
           "  handling: pose\n  estimate: {point: [0, 0, 1]}\n",
       {":5: targets[0].handling", "orientation"}},
      {"HeldWithAcceleration",
       "point: [0, 0, 1]\n  handling: {point: {motion: hold, acceleration: 3}}\n",
       {":4: targets[0].handling.point.acceleration", "hold does not use it"}},
      {"MovingWithHeldSpeed",
       "point: [0, 0, 1]\n  handling: {point: {motion: constant_velocity, held_speed: 3}}\n",
       {":4: ", "held_speed", "constant_velocity does not use it"}},
      {"StillWithAcceleration",
       "box3d: [0, 0, 1, 0, 0, 0, 1]" + solid +
           "  handling: {pose: {motion: still, acceleration: 3}}\n",
       {":5: ", "acceleration", "still does not use it"}},
      {"TwistWithDrift",
       "box3d: [0, 0, 1, 0, 0, 0, 1]" + solid + "  handling: {pose: {drift: 3}}\n",
       {":5: ", "drift", "constant_twist does not use it"}},
      {"KnownSpeedWithAcceleration",
       "box3d: [0, 0, 1, 0, 0, 0, 1]" + solid +
           "  handling: {pose: {motion: along_direction, direction: [1, 0, 0], speed: 0.1, "
           "acceleration: 3}}\n",
       {":5: ", "acceleration", "known speed does not use it"}},
      {"TrackerAtFault",
       "box: [1, 2, 3, 4]\n  handling: {point: {timeout: -1}}\n",
       {":4: targets[0].handling.point", "timeout"}},
  };
}

class TargetFaultsTest : public testing::Test {
 protected:
  TargetFaultsTest() {
    write_tiny_recording(folder_.path());
    io::write_png(folder_.path() / "small.png", Image<std::uint8_t>(7, 5, 1).view());
    io::write_png(folder_.path() / "empty.png", Image<std::uint8_t>(64, 48).view());
    write_file(folder_.path() / "odd.csv", "frame,u,w\n0,1,2\n");
    write_file(folder_.path() / "late.csv", "u,v,frame\n1,2,0\n");
    write_file(folder_.path() / "solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_file(folder_.path() / "twice.csv", "frame,u,v\n0,1,2\n0,1,2\n");
  }

  Outcome run(const std::string& text, const std::vector<std::string>& options = {}) {
    write_file(folder_.path() / "targets.yaml", text);
    std::vector<std::string> line{"run",       folder_.path(),
                                  "-o",        folder_.path() / "out",
                                  "--targets", folder_.path() / "targets.yaml"};
    line.insert(line.end(), options.begin(), options.end());
    return penumbra(line);
  }

  TemporaryFolder folder_;
};
void expect_fault(const Outcome& outcome, const std::vector<std::string>& words) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  for (const std::string& word : words)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in: " << outcome.err;
}

class BadTargetsTest : public TargetFaultsTest, public testing::WithParamInterface<BadTargets> {};
INSTANTIATE_TEST_SUITE_P(Regions, BadTargetsTest, testing::ValuesIn(bad_regions()), name_of);
INSTANTIATE_TEST_SUITE_P(Objects, BadTargetsTest, testing::ValuesIn(bad_objects()), name_of);
INSTANTIATE_TEST_SUITE_P(Settings, BadTargetsTest, testing::ValuesIn(bad_settings()), name_of);

TEST_P(BadTargetsTest, IsToldInOneLine) {
  expect_fault(run("targets:\n- name: a\n  " + GetParam().text), GetParam().words);
}

TEST_F(TargetFaultsTest, OfTheWholeFileAreTold) {
  expect_fault(run("- name: a\n"), {"targets.yaml:1"});
  expect_fault(run(""), {"targets.yaml"});
  expect_fault(run("goals: []\n"), {"targets.yaml:1", "goals"});
  expect_fault(run("targets:\n- {box: [1, 2, 3, 4]}\n"), {"targets.yaml:2", "name"});
  expect_fault(run("targets: []\nhistory: 61\n"), {"targets.yaml:2", "history", "60"});
  expect_fault(run("targets: []\nimage: bent\n"), {"targets.yaml:2", "raw or rectified"});
  expect_fault(penumbra({"run", folder_.path(), "-o", folder_.path() / "out", "--targets",
                         folder_.path() / "no.yaml"}),
               {"no.yaml"});
  edit_file(folder_.path() / "recording.yaml", "frames:", "targets: no.yaml\nframes:");
  expect_fault(penumbra({"run", folder_.path(), "-o", folder_.path() / "out"}),
               {"recording.yaml", "no.yaml"});
}

/// What the motions do use.
TEST_F(TargetFaultsTest, SettingsOfTheMotionAreTaken) {
  const std::string head =
      "targets:\n- name: a\n  box3d: [0, 0, 1, 0, 0, 0, 1]\n  size: [0.1, 0.1, 0.1]\n  handling: ";
  for (const char* const settings :
       {"{pose: {acceleration: 1, angular_acceleration: 1, speed_sigma: 1, angular_speed_sigma: "
        "1}}",
        "{pose: {motion: constant_velocity, acceleration: 1, speed_sigma: 1, angular_drift: 1}}",
        "{pose: {motion: along_direction, direction: [1, 0, 0], acceleration: 1, speed_sigma: 1, "
        "drift: 1, angular_drift: 1}}",
        "{pose: {motion: along_direction, direction: [1, 0, 0], speed: 1, drift: 1}}",
        "{pose: {motion: still, drift: 1, angular_drift: 1}}", "{point: {held_speed: 1}}",
        "{point: {motion: constant_velocity, acceleration: 1, speed_sigma: 1}}"})
    EXPECT_EQ(run(head + settings + "\n").status, 0) << settings;
}

/// Outside of the image a target is out of view, which is no fault: a moving one may get there.
TEST_F(TargetFaultsTest, OutsideOfTheImageIsOutOfView) {
  const Outcome outcome = run("targets:\n- {name: a, box: [500, 2, 9, 9]}\n");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("target a: 0 frames visible, 0 partial, 0 hidden, 0 unknown, 3 out"),
            std::string::npos)
      << outcome.out;
}

/// What single frames have wrong is theirs.
TEST_F(TargetFaultsTest, BadRowsAreFaultsOfTheirFrames) {
  write_file(folder_.path() / "p.csv",
             "frame,x,y,z,qx,qy,qz,qw\n0,0,0,2,0,0,0,0\n1,0,0,2,0,0,0,1\n2,0,0,nan,0,0,0,1\n");
  const Outcome outcome =
      run("targets:\n- {name: a, box3d: {csv: p.csv}, size: [0.1, 0.1, 0.1], handling: pose}\n");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 2U) << outcome.err;
  EXPECT_NE(outcome.err.find("note: targets that want handling in 3 frames without a stamp"),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("target 'a' unknown in 2 of 3 frames, first in frame 0: "),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("p.csv:2: quaternion has the length 0"), std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace penumbra::test
