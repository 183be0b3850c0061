// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <gtest/gtest.h>

#include <io/files/png.hpp>
#include <io/files/targets_file.hpp>

namespace penumbra::test {
namespace {

class TargetsFileTest : public testing::Test {
 protected:
  io::TargetsFile open(const std::string& text, ImageSpace image = ImageSpace::raw,
                       bool is_bent = false) {
    return io::TargetsFile::open(folder_.write("targets.yaml", text),
                                 {.robot = robot_,
                                  .image = image,
                                  .images = Intrinsics(64, 48, 60, 60, 31, 23),
                                  .is_bent = is_bent,
                                  .beyond_hides = true});
  }

  TemporaryFolder folder_;
  Robot robot_ = Robot::parse(R"(<robot name="r"><link name="base"/></robot>)", ".");
};

TEST_F(TargetsFileTest, GivesEachFrameItsValues) {
  folder_.write("k.csv",
                "frame,name,u,v,score\n0,a,1,2,0.5\n0,b,9,9,1\n2,a,nan,2,0.5\n3,a,7,8,1\n");
  io::TargetsFile file = open(
      "targets:\n- name: a\n  keypoint: {csv: k.csv}\n"
      "- name: box\n  box: {frames: {0: [1, 2, 3, 4], 1: null}}\n  extent: modal\n");
  const auto first = file.of_frame(0);
  ASSERT_EQ(first.size(), 2U);
  const auto& keypoint = std::get<KeypointTarget>(first[0].shape);
  EXPECT_EQ(keypoint.pixel, Eigen::Vector2d(1, 2));
  EXPECT_EQ(keypoint.score, 0.5);
  EXPECT_EQ(std::get<RegionTarget>(first[1].shape).extent, Extent::modal);
  EXPECT_EQ(std::get<PixelBox>(std::get<RegionTarget>(first[1].shape).region).height, 4.0);
  for (const std::int64_t frame : {1, 2}) {
    const auto none = file.of_frame(frame);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(none[0].shape)) << "never stale values";
    EXPECT_FALSE(none[0].fault.empty());
    EXPECT_FALSE(none[1].fault.empty());
  }
  EXPECT_NE(file.of_frame(2)[0].fault.find("k.csv:4: column 'u'"), std::string_view::npos);
  EXPECT_TRUE(file.of_frame(3)[0].fault.empty());
}

TEST_F(TargetsFileTest, FramesWithoutAnEstimateHaveNone) {
  io::TargetsFile file = open(
      "targets:\n- name: a\n  point: [0, 0, 1]\n  handling: point\n"
      "  estimate: {point: {frames: {0: [1, 2, 3], 1: null}}}\n"
      "- {name: b, point: [0, 0, 1], handling: point}\n");
  EXPECT_TRUE(std::holds_alternative<Eigen::Vector3d>(file.of_frame(0)[0].estimate->value));
  for (const std::int64_t frame : {1, 2}) {
    const auto targets = file.of_frame(frame);
    ASSERT_TRUE(targets[0].estimate) << "its own point would stand for it";
    EXPECT_TRUE(std::holds_alternative<std::monostate>(targets[0].estimate->value));
    EXPECT_FALSE(targets[1].estimate);
  }
}

TEST_F(TargetsFileTest, EstimatesSayHowSureTheyAre) {
  folder_.write("e.csv",
                "frame,x,y,z,qx,qy,qz,qw,position_sigma,orientation_sigma\n"
                "0,1,2,3,0,0,0,1,0.002,0.05\n1,1,2,3,0,0,0,1,0,0.05\n");
  const std::string head = "targets:\n- name: a\n  keypoint: [1, 2]\n  handling: ";
  io::TargetsFile file = open(head + "pose\n  estimate: {pose: {csv: e.csv}}\n");
  const auto& pose = file.of_frame(0)[0].estimate;
  ASSERT_TRUE(pose && pose->covariance);
  Matrix6d wanted = Matrix6d::Zero();
  wanted.diagonal() << 4e-6, 4e-6, 4e-6, 2.5e-3, 2.5e-3, 2.5e-3;
  EXPECT_TRUE(pose->covariance->isApprox(wanted)) << *pose->covariance;
  EXPECT_HAS(file.of_frame(1)[0].fault, "e.csv:3: sigma of the estimate is 0");
  EXPECT_FALSE(file.of_frame(1)[0].estimate) << "never one that is not sure";

  io::TargetsFile plain = open(head + "point\n  estimate: {point: [1, 2, 3, 0.01]}\n");
  EXPECT_DOUBLE_EQ((*plain.of_frame(0)[0].estimate->covariance)(1, 1), 1e-4);
  io::TargetsFile without = open(head + "point\n  estimate: {point: [1, 2, 3]}\n");
  EXPECT_FALSE(without.of_frame(0)[0].estimate->covariance);

  folder_.write("half.csv", "frame,x,y,z,qx,qy,qz,qw,position_sigma\n");
  EXPECT_HAS(input_error([&] {
               static_cast<void>(open(head + "pose\n  estimate: {pose: {csv: half.csv}}\n"));
             }),
             "half.csv:1: has some of the columns");
  EXPECT_HAS(input_error([&] {
               static_cast<void>(open(head + "point\n  estimate: {point: [1, 2, 3, -1]}\n"));
             }),
             ":5: targets[0].estimate.point: sigma");
}

/// One for all frames, and one for each: a frame without a file has no target.
TEST_F(TargetsFileTest, MasksAreReadFromFiles) {
  Image<std::uint8_t> mask(64, 48);
  mask(5, 7) = 255;
  io::write_png(folder_.path() / "all.png", mask.view());
  mask(6, 7) = 1;
  io::write_png(folder_.path() / "m_001.png", mask.view());
  io::write_png(folder_.path() / "m_003.png", Image<std::uint8_t>(9, 9, 1).view());
  io::TargetsFile file = open(
      "targets:\n- {name: all, mask: all.png, extent: modal, expected_depth: 1.5}\n"
      "- {name: each, mask: {files: m_%03d.png}}\n");
  const auto pixels = [](const Target& target) {
    const auto& region = std::get<RegionTarget>(target.shape);
    const auto& image = std::get<PixelMask>(region.region).mask;
    std::vector<Eigen::Vector2i> set;
    for (int v = 0; v < image.height; ++v)
      for (int u = 0; u < image.width; ++u)
        if (image(u, v) != 0) set.emplace_back(u, v);
    return set;
  };
  const auto targets = file.of_frame(1);
  EXPECT_EQ(pixels(targets[0]), (std::vector<Eigen::Vector2i>{{5, 7}}));
  EXPECT_EQ(pixels(targets[1]), (std::vector<Eigen::Vector2i>{{5, 7}, {6, 7}}));
  const auto& all = std::get<RegionTarget>(targets[0].shape);
  EXPECT_EQ(all.extent, Extent::modal);
  EXPECT_EQ(all.expected_depth, 1.5);
  const std::pair<std::int64_t, const char*> faults[] = {{2, "m_002.png"}, {3, "9 x 9"}};
  for (const auto& [frame, told] : faults) {
    const auto given = file.of_frame(frame);
    EXPECT_TRUE(given[0].fault.empty());
    EXPECT_TRUE(std::holds_alternative<std::monostate>(given[1].shape)) << "never a stale mask";
    EXPECT_NE(given[1].fault.find(told), std::string_view::npos) << given[1].fault;
  }
}

TEST_F(TargetsFileTest, FaultsNameFileAndLine) {
  io::write_png(folder_.path() / "small.png", Image<std::uint8_t>(7, 7, 1).view());
  folder_.write("odd.csv", "frame,u,w\n0,1,2\n");
  folder_.write("plain.csv", "frame,u,v\n0,1,2\n");
  const std::string head = "targets:\n- name: a\n  ";
  const std::pair<std::string, std::string> cases[] = {
      {head + "box: [1, 2, 0, 4]\n", ":3: targets[0].box: has no area"},
      {head + "box: [1, 2, .nan, 4]\n", ":3: "},
      {head + "box: [1, 2, 3]\n", ":3: targets[0].box: has 3 values"},
      {head + "boxx: [1, 2, 3, 4]\n", "says not where it is"},
      {head + "box: [1, 2, 3, 4]\n  radius: 3\n", ":4: targets[0].radius: unknown key"},
      {head + "box: [1, 2, 3, 4]\n- name: a\n  box: [1, 2, 3, 4]\n", ":4: targets[1].name: 'a'"},
      {head + "box3d: [0, 0, 1, 0, 0, 0, 0]\n  size: [1, 1, 1]\n", "quaternion has the length 0"},
      {head + "box3d: [0, 0, 1, 0, 0, 0, 2]\n  size: [1, 1, 1]\n", "quaternion"},
      {head + "point: [0, 0, 1]\n  link: arm\n", ":4: targets[0].link: 'arm' is no link"},
      {head + "mask: small.png\n", "7 x 7"},
      {head + "mask: {files: m%d.png}\n", "no file of that name"},
      {head + "polygon: [[1, 1], [2, 2]]\n", "fewer than 3"},
      {head + "rle: {size: [48, 64], counts: [5]}\n", "add up to 5"},
      {head + "keypoint: {csv: odd.csv}\n", "odd.csv:1: has no column 'v'"},
      {head + "keypoint: [1, 1]\n  min_score: 0.5\n", ":3: targets[0].keypoint: has 2 values"},
      {head + "keypoint: {csv: plain.csv}\n  min_score: 0.5\n",
       "plain.csv:1: has no column 'score'"},
      {head + "keypoint: [1, 1]\n  expected_depth: 1e30\n", ":3: targets[0].keypoint: expected"},
      {head + "keypoint: [1, 1]\n  radius: 1e12\n", "semi-axis is 1e+12"},
      {head + "keypoint: [1, 1e300]\n", ":3: targets[0].keypoint: pixel is 1e+300"},
      {head + "keypoint: [1, 1]\n  radius_m: 1e9\n", "semi-axis is 1e+09"},
      {head + "keypoint: [1, 1]\n  ellipse: [1, 1, 1e308]\n", "angle is"},
      {head + "box: [1, 2, 3, 4]\n  depth_margin: 1e30\n", ":4: targets[0].depth_margin: "},
      {head + "point: [0, 0, 1]\n  radius: 1e7\n", "radius is 1e+07"},
      {head + "box3d: [0, 0, 1e7, 0, 0, 0, 1]\n  size: [1, 1, 1]\n", "1000 km away"},
      {head + "box3d: [0, 0, 1, 0, 0, 0, 1]\n  size: [1e30, 1, 1]\n", "edge of the box is 1e+30"},
      {head + "box3d: [0, 0, 1, 0, 0, 0, 1]\n  size: [1, 1, 1]\n  thresholds: {min_inside: 0.5}\n",
       ":5: targets[0].thresholds.min_inside: is not possible"},
      {head + "mesh: [0, 0, 1, 0, 0, 0, 1]\n  file: nope.stl\n", ":4: targets[0].file: "},
      {head + "keypoint: [1, 1]\n  handling: point\n  estimate: {point: [1e308, 0, 0]}\n",
       ":5: targets[0].estimate.point: position is not finite, or more than"},
      {"targets:\n- name: \"a\\nb\"\n  box: [1, 2, 3, 4]\n", ":2: targets[0].name: has a control"},
      {head + "keypoint: [1, 1]\n  handling: hold\n", ":4: targets[0].handling: is 'hold'"},
      {head + "keypoint: [1, 1]\n  thresholds: {partial_enter: 2}\n", "partial_enter"},
      {head + "keypoint: [1, 1]\n  estimate: {point: [0, 0, 1]}\n", "not handled"}};
  for (const auto& [text, told] : cases) {
    const std::string message = input_error([&, &yaml = text] { static_cast<void>(open(yaml)); });
    EXPECT_HAS(message, told);
  }
}

TEST_F(TargetsFileTest, PixelsOfAnotherImageAreRefused) {
  const std::string text = "targets:\n- name: a\n  box: [1, 2, 3, 4]\n";
  EXPECT_HAS(input_error([&] { static_cast<void>(open(text, ImageSpace::rectified, true)); }),
             "raw image");
  EXPECT_EQ(open("image: rectified\n" + text, ImageSpace::rectified, true).size(), 1U);
}

TEST_F(TargetsFileTest, TargetsWithoutPixelsAreOfAnyImage) {
  const std::string text = "targets:\n- name: a\n  point: [0, 0, 1]\n  radius: 0.1\n";
  EXPECT_EQ(open(text, ImageSpace::rectified, true).size(), 1U);
  EXPECT_EQ(open("image: rectified\n" + text, ImageSpace::raw, true).size(), 1U);
  EXPECT_HAS(input_error([&] {
               static_cast<void>(open(text + "- name: b\n  keypoint: [1, 2]\n  radius: 3\n",
                                      ImageSpace::rectified, true));
             }),
             "raw image");
}

}  // namespace
}  // namespace penumbra::test
