// SPDX-License-Identifier: Apache-2.0
// penumbra calibrate on a real recording, on the shipped one, and on what it must refuse.
#include "../support/page_json.hpp"
#include "../support/pixels.hpp"
#include "real_recording.hpp"

#include <io/files/camera_info.hpp>

namespace penumbra::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class CalibrateTest : public RealRecording {
 protected:
  [[nodiscard]] Isometry3d published() const {
    return io::read_pose_csv(path("recording/camera_pose.csv"));
  }
};

TEST_F(CalibrateTest, StartsDoNotMatter) {
  succeed(calibrate());
  const Isometry3d first = found();
  const Json json = calibration();
  EXPECT_LT(metres_between(first, published()), 1.5 * json["position_error_95_m"].get<double>());
  EXPECT_TRUE(json["link_residuals_m"].contains("link7"));
  const std::string page = read_file(out("report.html"));
  EXPECT_EQ(page_json(page, "penumbra-report"), json);
  EXPECT_EQ(page_json(page, "penumbra-pictures")[1]["caption"], "frame 0, result");
  succeed(calibrate(initial(off(published()))));
  constexpr double same = 0.002;  // metres; docs/calibration.md
  EXPECT_LT(metres_between(first, found()), same);
}

TEST_F(CalibrateTest, MasksGiveTheColourImagesPose) {
  succeed(calibrate({"--masks", "robot_mask_%d.png"}));
  EXPECT_GT(calibration()["masks"]["overlap"], 0.926) << "that of the published pose";
}

TEST_F(CalibrateTest, RefusesTooFewFramesAndOtherRobots) {
  expect_failed(calibrate({"--frames", "0:2"}), {"3 frames"});
  EXPECT_EQ(calibrate({"--masks", "none_%d.png"}).status, 2);
  EXPECT_EQ(calibrate(initial(off(published())) + Words{"--search"}).status, 2);

  // The images of the next frames: the robot is elsewhere than the joints say.
  const auto depth = [&](int i) { return path("recording/depth_" + std::to_string(i) + ".png"); };
  fs::rename(depth(0), path("first.png"));
  for (int i = 1; i < 10; ++i) fs::rename(depth(i), depth(i - 1));
  fs::rename(path("first.png"), depth(9));
  expect_failed(calibrate(), {"not calibrated"});
  EXPECT_FALSE(fs::exists(out("camera_pose.csv")));
}

/// Five poses, without masks of one of them. Their published pose is good to a centimetre or two.
class CalibrateFewPoses : public CalibrateTest {
 protected:
  void SetUp() override {
    CalibrateTest::SetUp();
    if (!IsSkipped()) copy_real_recording("xarm7_realsense_2", path("recording"));
  }
  /// The found pose is as near to the published one as it says, and within the limit.
  void expect_near() const {
    const Json json = calibration();
    Isometry3d pose;
    for (int i = 0; i < 16; ++i)
      pose(i / 4, i % 4) = json["T_parent_camera"][std::size_t(i / 4)][std::size_t(i % 4)];
    constexpr double near = 0.015;  // metres
    EXPECT_LT(metres_between(pose, published()),
              std::min(near, json["position_error_95_m"].get<double>()));
  }
};

TEST_F(CalibrateFewPoses, GiveAPoseThatSaysHowWellItIsKnown) {
  const Outcome outcome = calibrate();
  EXPECT_EQ(outcome.status, 2);
  expect_has(outcome.out, {"static_transform_publisher"});
  expect_has(outcome.err, {"--masks", "--accept"});
  EXPECT_EQ(calibration()["good"], false);
  EXPECT_FALSE(fs::exists(out("camera_pose.csv")));
  expect_near();
  succeed(calibrate({"--accept", "60"}));
  EXPECT_TRUE(fs::exists(out("camera_pose.csv")));
  succeed(calibrate({"--masks", "robot_mask_%d.png"}));
  expect_near();
}

TEST_F(CalibrateFewPoses, WithoutTheFourthAreNotAcceptedWrongly) {
  const std::string joints = read_file(path("recording/joint_states.csv"));
  const auto row = joints.find("\n3,");
  write("recording/joint_states.csv",
        joints.substr(0, row) + joints.substr(joints.find('\n', row + 1)));
  EXPECT_EQ(calibrate(initial(off(published()))).status, 2);
  expect_near();
}

/// The shipped recording without depth, with the masks that `run` writes of it.
class CalibrateMasksTest : public ExampleRecording {
 protected:
  CalibrateMasksTest() {
    succeed(run("recording/masks", {"--save", "robot_mask"}));
    edit("  depth: depth/%d.png", "");
  }
  const Words masks = {"--masks", "masks/robot_mask/%06d.png"};
};

TEST_F(CalibrateMasksTest, FindsThePoseByTheFramesWithAMaskAndRefusesWhatNeedsDepth) {
  fs::remove(path("recording/masks/robot_mask/000002.png"));
  const Outcome outcome =
      succeed(calibrate(masks + initial(off(truth_, {0.04, -0.05, 0.05}, 0.0))));
  expect_has(outcome.out, {"overlap with the masks"});
  expect_has(outcome.err, {"frames without one are left out: 1"});
  constexpr double limit = 0.002;  // metres: exact masks of poses that are near each other
  EXPECT_LT(metres_between(found(), truth_), limit);
  const Json json = calibration();
  EXPECT_TRUE(json["depth_offset_m"].is_null());
  EXPECT_GT(json["masks"]["overlap"], 0.99);
  EXPECT_EQ(page_json(read_file(out("report.html")), "penumbra-report"), json);
  for (const auto& [options, named] :
       {std::pair(masks + Words{"--joint-offsets"}, "need depth images"),
        {masks + Words{"--time-offset"}, "need depth images"},
        {Words{}, "by --images or --masks"},
        {Words{"--masks", "color/%d.png"}, ""}})
    expect_failed(calibrate(options), {named});
}

TEST_F(CalibrateMasksTest, WhatAMaskDoesNotKnowIsLeftOut) {
  constexpr std::uint8_t not_known = 128;
  for (const auto& file : fs::directory_iterator(path("recording/masks/robot_mask"))) {
    auto mask = read_image<std::uint8_t>(file.path());
    for (const auto [u, v] : each_pixel(mask))
      if (v / 8 % 3 != 0) mask(u, v) = not_known;  // two thirds of its rows
    io::write_png(file.path(), std::as_const(mask).view());
  }
  succeed(calibrate(masks));
  constexpr double limit = 0.002;  // metres: as with all of them
  EXPECT_LT(metres_between(found(), truth_), limit);
  EXPECT_GT(calibration()["masks"]["overlap"], 0.98);
}

/// The shipped recording's colour images alone.
class CalibrateImagesTest : public ExampleRecording {
 protected:
  CalibrateImagesTest() { edit("  depth: depth/%d.png", ""); }
  Outcome by_images(const Words& options) const { return calibrate(Words{"--images"} + options); }
};

TEST_F(CalibrateImagesTest, RefuseWhatTheyCannotTell) {
  expect_failed(by_images({"--masks", "mask_%d.png"}), {"--masks is given too"});
  expect_failed(by_images({"--joint-offsets"}), {"need depth images"});
  expect_failed(by_images({"--frames", "0:1"}), {"3 frames"});
  edit("parent: base_link", "parent: wrist_1_link");
  expect_failed(by_images({}), {"a camera that stands still, and wrist_1_link moves"});
  edit("parent: wrist_1_link", "parent: base_link");

  // The camera shows a still picture while the joints move, then images of another size.
  for (const auto& file : fs::directory_iterator(path("recording/color")))
    fs::copy_file(example / "color/0.png", file.path(), fs::copy_options::overwrite_existing);
  expect_failed(by_images({}), {"do not show the robot move as its joints say"});
  EXPECT_FALSE(fs::exists(out("camera_pose.csv")));
  const Image<Rgb8> small(64, 48);
  io::write_png(path("recording/color/1.png"), small.view());
  expect_has(by_images({}).err, {"has 64 x 48 pixels"});
}

/// Real webcams with strong lenses; a board on the flange, whose corners gave the pose, is not in
/// the URDF. Four images of the second are of another view.
using CalibrateWebcam = RecordingTest;

TEST_F(CalibrateWebcam, FindsThePoseOfTheBoard) {
  PENUMBRA_REQUIRE_DATA();
  const fs::path webcam = data_folder() / "ur3e_webcam_4";
  const Isometry3d board = io::read_pose_csv(webcam / "board_pose.csv");
  const Words line = Words{"calibrate", webcam, "--images", "-o", out()} + initial(off(board));
  expect_has(succeed(penumbra(line)).err, {"frame 15 is left out"});
  constexpr double near = 0.006;  // metres; the board's pose is good to one or two millimetres
  EXPECT_LT(metres_between(found(), board), near);
}

/// The same camera is given elsewhere, and right.
TEST_F(CalibrateWebcam, AWrongPoseIsNamedByTheImages) {
  PENUMBRA_REQUIRE_DATA();
  fs::copy(data_folder() / "ur3e_webcam_1", path("recording"));
  edit("urdf: ..", "urdf: " + data_folder().string());
  edit("ur_description: ..", "ur_description: " + data_folder().string());
  const Isometry3d right = io::read_pose_csv(path("recording/board_pose.csv"));
  Isometry3d moved = right;
  moved.translation() += Vector3d(0.03, -0.03, 0.02);
  for (const auto& [pose, cause] :
       {std::pair(right, Json()), {moved, "camera_pose"}, {right.inverse(), "camera_inverted"}}) {
    io::write_pose_csv(path("recording/board_pose.csv"), pose);
    succeed(run("out", {"--save", "labels", "--force"}));
    EXPECT_EQ(report()["summary"]["compared_poses"], 20);
    EXPECT_EQ(cause_told(), cause);
  }
}

using CalibrateOfAnUnknownCamera = ExampleRecording;

TEST_F(CalibrateOfAnUnknownCamera, IsSearchedFor) {
  edit("  parent: base_link", "  #");
  edit("  pose: camera_pose.csv", "  #");
  for (const Outcome& outcome : {run("no"), calibrate()})
    expect_failed(outcome, {"calibrate --search"});
  succeed(calibrate({"--search"}));
  expect_has(calibration()["notes"].dump(), {"the arm moves in most frames"});
  constexpr double near = 0.003;  // metres; docs/calibration.md: the robot moves in most frames
  EXPECT_LT(metres_between(found(), truth_), near);
}

/// What run, tune and calibrate say of a real recording whose setup is wrong.
class DiagnosisTest : public CalibrateTest {
 protected:
  /// Runs and expects this status and cause; null: none.
  Outcome expect_cause(int status, const Json& cause) {
    const Outcome outcome = run("out");
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(cause_told(), cause);
    return outcome;
  }
};

TEST_F(DiagnosisTest, AnInvertedPoseEndsWithStatus2) {
  io::write_pose_csv(path("recording/camera_pose.csv"), published().inverse());
  expect_lacks(expect_cause(2, "camera_inverted").out, {" 0 bad"});
  succeed(run("out", {"--force"}));
}

TEST_F(DiagnosisTest, TuneRefusesAWrongPose) {
  io::write_pose_csv(path("recording/camera_pose.csv"), off(published(), {0.05, 0, 0}, 0));
  expect_cause(0, "camera_pose");
  expect_failed(penumbra({"tune", path("recording"), "-o", path("tuned")}), {"penumbra calibrate"});
  EXPECT_FALSE(fs::exists(path("tuned")));
}

TEST_F(DiagnosisTest, DepthScaleMendsDepthOfAnotherUnit) {
  expect_cause(0, nullptr);
  edit("  pose:", "  depth_scale: 0.01\n  pose:");
  const std::string note = expect_cause(2, "depth_unit").err;
  expect_has(note, {"depth_scale", "multiply it by 0.1"});
  expect_failed(penumbra({"calibrate", path("recording")}), {"depth_scale"});
  edit("0.01\n", "0.001\n");
  expect_cause(0, nullptr);
  edit("0.001\n", "0\n");
  expect_failed(run("out"), {"depth_scale"});
}

TEST_F(DiagnosisTest, NormalisedDepthAndDepthAlongTheRay) {
  const Camera camera = io::read_camera_info(path("recording/camera_info.yaml"), false);
  const auto write_depth = [&](const std::function<double(double z, double ray)>& given) {
    for (std::size_t i = 0; i < 10; ++i) {
      const std::string name = "recording/depth_" + std::to_string(i);
      const auto read = read_image<std::uint16_t>(path(name + ".png"));
      Image<float> depth(read.width(), read.height());
      for (const auto [u, v] : each_pixel(depth))
        depth(u, v) =
            static_cast<float>(given(0.001 * read(u, v), camera.intrinsics.ray(u, v).norm()));
      io::write_npy(path(name + ".npy"), depth.view());
    }
  };
  edit("depth_%d.png", "depth_%d.npy");
  write_depth([](double z, double) { return std::min(z / 4.0, 1.0); });
  expect_has(expect_cause(0, "depth_scale").err, {"depth_scale"});
  write_depth([](double z, double ray) { return z * ray; });
  expect_has(expect_cause(0, "depth_ray").err, {"set depth_along to ray"});
  edit("  pose:", "  depth_along: ray\n  pose:");
  expect_cause(0, nullptr);
}

}  // namespace
}  // namespace penumbra::test
