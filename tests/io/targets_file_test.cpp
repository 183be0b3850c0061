// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"
#include "robots.hpp"

#include <io/files/png.hpp>
#include <io/files/targets_file.hpp>

namespace penumbra::test {
namespace {

class TargetsFileTest : public testing::Test {
 protected:
  io::TargetsFile open(const std::string& text, ImageSpace image = ImageSpace::raw,
                       bool has_distortion = false) {
    return io::TargetsFile::open(folder_.write("targets.yaml", text),
                                 {.robot = robot_,
                                  .image = image,
                                  .images = Intrinsics(64, 48, 60, 60, 31, 23),
                                  .has_distortion = has_distortion,
                                  .beyond_hides = true});
  }

  TemporaryFolder folder_;
  Robot robot_ = bare_robot();
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
  const auto pose = file.of_frame(0)[0].estimate;
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
    const auto& image = std::get<PixelMask>(region.region).mask.view;
    std::vector<Eigen::Vector2i> set;
    for (const auto [u, v] : each_pixel(image))
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

// The text of target `a` behind its name, and what the error names.
TEST_F(TargetsFileTest, FaultsNameFileAndLine) {
  io::write_png(folder_.path() / "small.png", Image<std::uint8_t>(7, 5, 1).view());
  io::write_png(folder_.path() / "empty.png", Image<std::uint8_t>(64, 48).view());
  io::write_png(folder_.path() / "color.png", Image<Rgb8>(64, 48).view());
  folder_.write("odd.csv", "frame,u,w\n0,1,2\n");
  folder_.write("late.csv", "u,v,frame\n1,2,0\n");
  folder_.write("twice.csv", "frame,u,v\n0,1,2\n0,1,2\n");
  folder_.write("plain.csv", "frame,u,v\n0,1,2\n");
  folder_.write("half.csv", "frame,x,y,z,qx,qy,qz,qw,position_sigma\n");
  folder_.write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto open_target = [&](const std::string& text) {
    return open("targets:\n- name: a\n  " + text);
  };
  const std::string pose = "box3d: [0, 0, 1, 0, 0, 0, 1]\n  size: [0.1, 0.1, 0.1]\n";
  const std::string mesh = "mesh: [0, 0, 1, 0, 0, 0, 1]\n  file: ", size = "\n  size: [1, 1, 1]\n";
  const std::string keypoint = "keypoint: [5, 5]\n  ", box = "box: [1, 2, 3, 4]\n  ";
  test::expect_refused(
      {{"box: [1, 2, 0, 4]\n", ":3: targets[0].box: "},
       {"box: [0.71, 0.38, 0.06, 0.2]\n", ":3: targets[0].box: lies within the first"},
       {"keypoint: [0.7, 0.4]\n", "first pixel"},
       {"polygon: [[0.1, 0.1], [0.9, 0.1], [0.5, 0.9]]\n", "first pixel"},
       {"box: [1, .nan, 3, 4]\n", ":3: targets[0].box"},
       {"box: [1, 2, 3]\n", "width, height"},
       {"polygon:\n    frames:\n      0: [[1, 1], [20, 1], [20, 20]]\n"
        "      1: [[1, 1], [20, 20], [9, 9]]\n",
        ":6: targets[0].polygon.frames.1"},
       {"polygon: [[1, 1], [2, 2]]\n", ":3: targets[0].polygon"},
       {"mask: no.png\n", "no.png"},
       {"mask: small.png\n", "64 x 48"},
       {"mask: empty.png\n", "without any pixel"},
       {"mask: color.png\n", "color.png"},
       {"mask: {files: m%d.png}\n", ":3: targets[0].mask.files"},
       {"rle: {size: [64, 48], counts: [3072]}\n", "another size"},
       {"rle: {size: [48, 64], counts: [5]}\n", "add up to 5"},
       {"rle: {size: [48, 64], counts: [3072]}\n", "without any pixel"}},
      open_target);
  test::expect_refused(
      {{keypoint + "radius: 0\n", ":4: targets[0].radius"},
       {keypoint + "min_score: 0.5\n", ":3: targets[0].keypoint"},
       {keypoint + "expected_depth: 1870\n", "expected depth is 1870 m: are these"},
       {box + "height: 1800\n", "height is 1800 m: are these millimetres"},
       {box + "depth_margin: 20\n", "millimetres"},
       {"keypoint: {csv: no.csv}\n", "no.csv"},
       {"keypoint: {csv: odd.csv}\n", "odd.csv:1: has no column 'v'"},
       {"keypoint: {csv: late.csv}\n", "late.csv:1"},
       {"keypoint: {csv: twice.csv}\n", "twice.csv:3"},
       {"keypoint: {csv: plain.csv}\n  min_score: 0.5\n", "'score'"},
       {"box3d: [0, 0, 1, 0, 0, 0, 0]" + size, ":3: targets[0].box3d: quaternion"},
       {"box3d: [0, 0, 1e7, 0, 0, 0, 1]" + size, "1000 km"},
       {"box3d: [0, 0, 1, 0, 0, 0, 1]\n  size: [0.1, 0, 0.1]\n", ":4: "},
       {"point: [0, .nan, 1]\n", ":3: targets[0].point"},
       {"point: [0, 0, 1]\n  link: arm\n", ":4: targets[0].link: 'arm'"},
       {mesh + "solid.obj\n  scale: 1e30\n", ":5: targets[0].scale"},
       {mesh + "nope.stl\n", ":4: targets[0].file: "},
       {"boxx: [1, 2, 3, 4]\n", ":2: targets[0]"},
       {box + "radius: 3\n", ":4: targets[0].radius"},
       {box + "extend: modal\n", "extent"},
       {box + "point: [0, 0, 1]\n", "point"},
       {"box: [1, 2, 3, 4]\n- name: a\n  box: [1, 2, 3, 4]\n", ":4: targets[1]"}},
      open_target);
  const std::string along = "{pose: {motion: along_direction, direction: [1, 0, 0], speed: 0.1, ";
  test::expect_refused(
      {{box + "frame_id: other\n", ":4: targets[0].frame_id"},
       {box + "depth_margin: 1e30\n", ":4: targets[0].depth_margin"},
       {box + "thresholds: {partial_enter: 0.1, partial_leave: 0.2}\n", "targets[0].thresholds"},
       {pose + "  thresholds: {min_inside: 0.5}\n", ":5: targets[0].thresholds.min_inside"},
       {box + "handling: hold\n", ":4: targets[0].handling: is 'hold'"},
       {box + "handling: pose\n", ":4: targets[0].handling"},
       {box + "handling: {point: {timeout: -1}}\n", "timeout"},
       {keypoint + "handling: {pose: {motion: still}}\n", ":4: targets[0].handling"},
       {"point: [0, 0, 1]\n  handling: pose\n", ":4: targets[0].handling"},
       {pose + "  handling: pose\n  estimate: {point: [0, 0, 1]}\n", "orientation"},
       {"point: [0, 0, 1]\n  handling: {point: {motion: hold, acceleration: 3}}\n", "acceleration"},
       {pose + "  handling: {pose: {drift: 3}}\n", "drift"},
       {pose + "  handling: " + along + "acceleration: 3}}\n", "acceleration"},
       {keypoint + "estimate: {point: [0, 0, 1]}\n", "not handled"},
       {keypoint + "handling: pose\n  estimate: {pose: [0, 0, 1, 0, 0, 0, 0]}\n", "quaternion"},
       {keypoint + "handling: point\n  estimate: {point: [0, 0, 0]}\n", "from the camera"},
       {keypoint + "handling: point\n  estimate: {point: [1, 2, 3, -1]}\n", "sigma"},
       {keypoint + "handling: pose\n  estimate: {pose: {csv: half.csv}}\n", "half.csv:1"}},
      open_target);
  test::expect_refused({{"- name: a\n", "targets.yaml:1"},
                        {"", "targets.yaml"},
                        {"goals: []\n", "targets.yaml:1: goals"},
                        {"targets:\n- {box: [1, 2, 3, 4]}\n", "targets.yaml:2"},
                        {"targets:\n- name: \"a\\nb\"\n  box: [1, 2, 3, 4]\n", "control"},
                        {"targets: []\nhistory: 61\n", "targets.yaml:2: history"},
                        {"targets: []\nimage: bent\n", "targets.yaml:2: image"}},
                       [&](const std::string& text) { return open(text); });
}

/// What a motion uses is taken.
TEST_F(TargetsFileTest, SettingsOfTheMotionAreTaken) {
  for (const char* const settings :
       {"{pose: {acceleration: 1, angular_acceleration: 1, speed_sigma: 1}}",
        "{pose: {motion: constant_velocity, acceleration: 1, speed_sigma: 1, angular_drift: 1}}",
        "{pose: {motion: along_direction, direction: [1, 0, 0], acceleration: 1, drift: 1}}",
        "{pose: {motion: along_direction, direction: [1, 0, 0], speed: 1, drift: 1}}",
        "{pose: {motion: still, drift: 1, angular_drift: 1}}", "{point: {held_speed: 1}}",
        "{point: {motion: constant_velocity, acceleration: 1, speed_sigma: 1}}"})
    EXPECT_EQ(
        open("targets:\n- {name: a, box3d: [0, 0, 1, 0, 0, 0, 1], size: [1, 1, 1], handling: " +
             std::string(settings) + "}\n")
            .size(),
        1U)
        << settings;
}

/// Pixels are of one image; what has none is of any.
TEST_F(TargetsFileTest, PixelsOfAnotherImageAreRefused) {
  const std::string box = "targets:\n- {name: a, box: [1, 2, 3, 4]}\n";
  const std::string point = "targets:\n- {name: a, point: [0, 0, 1], radius: 0.1}\n";
  EXPECT_HAS(test::refusal([&] { return open(box, ImageSpace::rectified, true); }), "raw image");
  EXPECT_EQ(open("image: rectified\n" + box, ImageSpace::rectified, true).size(), 1U);
  EXPECT_EQ(open(point, ImageSpace::rectified, true).size(), 1U);
  EXPECT_EQ(open("image: rectified\n" + point, ImageSpace::raw, true).size(), 1U);
}

}  // namespace
}  // namespace penumbra::test
