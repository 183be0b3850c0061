// SPDX-License-Identifier: Apache-2.0
// penumbra calibrate on a real recording, on the shipped one, and on what it must refuse.
#include "../support/page_json.hpp"
#include "real_recording.hpp"

#include <algorithm>
#include <sstream>

#include <io/files/camera_info.hpp>
#include <io/files/png.hpp>
#include <io/files/pose_file.hpp>

namespace penumbra::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

double metres_between(const Isometry3d& a, const Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

class CalibrateTest : public RealRecording {
 protected:
  Outcome calibrate(const Words& options) const {
    return penumbra(Words{"calibrate", recorded} + options);
  }
  [[nodiscard]] Isometry3d found(const std::string& folder) const {
    return io::read_pose_csv(path(folder) / "camera_pose.csv");
  }

  /// Writes the recording's own pose, moved by some centimetres and turned.
  [[nodiscard]] fs::path pose_off() const {
    Isometry3d pose = io::read_pose_csv(recorded / "camera_pose.csv");
    pose.translation() += Vector3d(0.05, -0.06, 0.05);
    pose.linear() =
        pose.linear() * Eigen::AngleAxisd(0.15, Vector3d(1, 2, -1).normalized()).matrix();
    io::write_pose_csv(path("off.csv"), pose);
    return path("off.csv");
  }

  const fs::path recorded = data_folder() / "xarm7_realsense";
};

TEST_F(CalibrateTest, StartsDoNotMatter) {
  succeed(calibrate({"-o", path("a")}));
  succeed(calibrate({"--initial", pose_off(), "-o", path("b")}));
  constexpr double same = 0.002;  // metres; docs/calibration.md
  const Json json = read_json(path("a/calibration.json"));
  EXPECT_LT(metres_between(found("a"), found("b")), same);
  EXPECT_LT(metres_between(found("a"), io::read_pose_csv(recorded / "camera_pose.csv")),
            1.5 * json["position_error_95_m"].get<double>());
  EXPECT_TRUE(json["link_residuals_m"].contains("link7"));
  const std::string page = read_file(path("a/report.html"));
  EXPECT_EQ(page_json(page, "penumbra-report"), json);
  EXPECT_EQ(page_json(page, "penumbra-pictures")[1]["caption"], "frame 0, result");
}

TEST_F(CalibrateTest, MasksGiveTheColourImagesPose) {
  succeed(calibrate({"--masks", "robot_mask_%d.png", "-o", path("a")}));
  EXPECT_GT(read_json(path("a/calibration.json"))["masks"]["overlap"], 0.926)
      << "that of the published pose";
}

TEST_F(CalibrateTest, RefusesTooFewFramesAndOtherRobots) {
  expect_failed(calibrate({"--frames", "0:2"}), {"3 frames"});
  EXPECT_EQ(calibrate({"--masks", "none_%d.png"}).status, 2);
  EXPECT_EQ(calibrate({"--search", "--initial", pose_off()}).status, 2);

  // The joints of the next frames: the robot is elsewhere than they say.
  std::istringstream joints(read_file(path("recording/joint_states.csv")));
  Words frames, positions;
  for (std::string line; frames.size() < 11 && std::getline(joints, line);) {
    frames.push_back(line.substr(0, line.find(',')));
    positions.push_back(line.substr(line.find(',')) + "\n");
  }
  std::string turned = frames[0] + positions[0];
  for (std::size_t i = 1; i < 11; ++i) turned += frames[i] + positions[1 + i % 10];
  write_file(path("recording/joint_states.csv"), turned);
  expect_failed(penumbra({"calibrate", path("recording"), "-o", out()}), {"not calibrated"});
  EXPECT_FALSE(fs::exists(out("camera_pose.csv")));
}

/// Five poses, without masks of one of them. Their published pose is good to a centimetre or two.
class CalibrateFewPoses : public RealRecording {
 protected:
  void SetUp() override {
    RealRecording::SetUp();
    if (!IsSkipped()) copy_recording("xarm7_realsense_2");
  }
  Outcome calibrate(const Words& options) const {
    return penumbra(Words{"calibrate", path("recording"), "-o", out()} + options);
  }
  /// The found pose is as near to the published one as it says, and within the limit.
  void expect_near(const fs::path& published) const {
    const Json json = read_json(out("calibration.json"));
    Isometry3d pose;
    for (int i = 0; i < 16; ++i)
      pose(i / 4, i % 4) = json["T_parent_camera"][std::size_t(i / 4)][std::size_t(i % 4)];
    const double off = metres_between(pose, io::read_pose_csv(published));
    EXPECT_LT(off, near);
    EXPECT_LT(off, json["position_error_95_m"].get<double>());
  }

  static constexpr double near = 0.015;  // metres
};

TEST_F(CalibrateFewPoses, GiveAPoseThatSaysHowWellItIsKnown) {
  const fs::path published = path("recording/camera_pose.csv");
  const Outcome outcome = calibrate({});
  EXPECT_EQ(outcome.status, 2);
  expect_has(outcome.out, {"static_transform_publisher"});
  expect_has(outcome.err, {"--masks", "--accept"});
  EXPECT_EQ(read_json(out("calibration.json"))["good"], false);
  EXPECT_FALSE(fs::exists(out("camera_pose.csv")));
  expect_near(published);
  succeed(calibrate({"--accept", "60"}));
  EXPECT_TRUE(fs::exists(out("camera_pose.csv")));
  succeed(calibrate({"--masks", "robot_mask_%d.png"}));
  expect_near(published);
}

TEST_F(CalibrateFewPoses, WithoutTheFourthAreNotAcceptedWrongly) {
  const fs::path published = path("recording/camera_pose.csv");
  const std::string joints = read_file(path("recording/joint_states.csv"));
  const auto row = joints.find("\n3,");
  write_file(path("recording/joint_states.csv"),
             joints.substr(0, row) + joints.substr(joints.find('\n', row + 1)));
  Isometry3d off = io::read_pose_csv(published);
  off.translation() += Vector3d(0.05, -0.06, 0.05);
  off.linear() = off.linear() * Eigen::AngleAxisd(0.15, Vector3d(1, 2, -1).normalized()).matrix();
  io::write_pose_csv(path("off.csv"), off);
  EXPECT_EQ(calibrate({"--initial", path("off.csv")}).status, 2);
  expect_near(published);
}

/// The shipped recording without depth, with the masks that `run` writes of it.
class CalibrateMasksTest : public FolderTest {
 protected:
  CalibrateMasksTest() {
    fs::copy(example, path("masked"), fs::copy_options::recursive);
    succeed(penumbra({"run", path("masked"), "-o", path("masked/out"), "--save", "robot_mask"}));
    edit_file(path("masked/recording.yaml"), "  depth: depth/%d.png", "");
  }
  Outcome calibrate(const Words& options) const {
    return penumbra(Words{"calibrate", path("masked")} + options);
  }

  const Words masks = {"--masks", "out/robot_mask/%06d.png"};
};

TEST_F(CalibrateMasksTest, FindsThePoseOfTheMasks) {
  const Isometry3d truth = io::read_pose_csv(example / "camera_pose.csv");
  Isometry3d off = truth;
  off.translation() += Vector3d(0.04, -0.05, 0.05);
  io::write_pose_csv(path("off.csv"), off);
  expect_has(succeed(calibrate(masks + Words{"--initial", path("off.csv"), "-o", out()})).out,
             {"overlap with the masks"});
  constexpr double limit = 0.002;  // metres: exact masks of poses that are near each other
  EXPECT_LT(metres_between(io::read_pose_csv(out("camera_pose.csv")), truth), limit);
  const Json json = read_json(out("calibration.json"));
  EXPECT_TRUE(json["depth_offset_m"].is_null());
  EXPECT_GT(json["masks"]["overlap"], 0.99);
  EXPECT_EQ(page_json(read_file(out("report.html")), "penumbra-report"), json);
}

TEST_F(CalibrateMasksTest, LeavesOutFramesWithoutAMaskAndRefusesWhatNeedsDepth) {
  fs::remove(path("masked/out/robot_mask/000002.png"));
  expect_has(succeed(calibrate(masks)).err, {"frames without one are left out: 1"});
  for (const auto& [options, named] :
       {std::pair(masks + Words{"--joint-offsets"}, "need depth images"),
        {masks + Words{"--time-offset"}, "need depth images"},
        {Words{}, "by --images or --masks"},
        {Words{"--masks", "color/%d.png"}, ""}}) {
    expect_failed(calibrate(options), {named});
  }
}

TEST_F(CalibrateMasksTest, WhatAMaskDoesNotKnowIsLeftOut) {
  constexpr std::uint8_t not_known = 128;
  for (const auto& file : fs::directory_iterator(path("masked/out/robot_mask"))) {
    Image<std::uint8_t> mask;
    ASSERT_TRUE(io::read_png(file.path(), mask, {}).ok());
    for (int v = 0; v < mask.height(); ++v)  // two thirds of its rows
      for (int u = 0; u < mask.width(); ++u)
        if (v / 8 % 3 != 0) mask(u, v) = not_known;
    io::write_png(file.path(), std::as_const(mask).view());
  }
  succeed(calibrate(masks + Words{"-o", out()}));
  constexpr double limit = 0.002;  // metres: as with all of them
  EXPECT_LT(metres_between(io::read_pose_csv(out("camera_pose.csv")),
                           io::read_pose_csv(example / "camera_pose.csv")),
            limit);
  EXPECT_GT(read_json(out("calibration.json"))["masks"]["overlap"], 0.98);
}

/// The shipped recording's colour images alone.
class CalibrateImagesTest : public FolderTest {
 protected:
  CalibrateImagesTest() {
    fs::copy(example, path("in"), fs::copy_options::recursive);
    edit_file(path("in/recording.yaml"), "  depth: depth/%d.png", "");
  }
  Outcome calibrate(const Words& options) const {
    return penumbra(Words{"calibrate", path("in"), "--images"} + options);
  }
};

TEST_F(CalibrateImagesTest, FindThePose) {
  const Isometry3d truth = io::read_pose_csv(example / "camera_pose.csv");
  Isometry3d off = truth;
  off.translation() += Vector3d(0.04, -0.05, 0.05);
  off.linear() = off.linear() * Eigen::AngleAxisd(0.12, Vector3d(1, 2, -1).normalized()).matrix();
  io::write_pose_csv(path("off.csv"), off);
  succeed(calibrate({"--initial", path("off.csv"), "-o", out()}));
  constexpr double near = 0.006;  // metres: the poses are near each other
  const Json json = read_json(out("calibration.json"));
  const double found = metres_between(io::read_pose_csv(out("camera_pose.csv")), truth);
  EXPECT_LT(found, near);
  EXPECT_LT(found, json["position_error_95_m"].get<double>());
  const Json pictures = page_json(read_file(out("report.html")), "penumbra-pictures");
  EXPECT_EQ(pictures[0]["caption"], "frame 0, first guess");
}

TEST_F(CalibrateImagesTest, RefuseWhatTheyCannotTell) {
  expect_failed(calibrate({"--masks", "mask_%d.png"}), {"--masks is given too"});
  expect_failed(calibrate({"--joint-offsets"}), {"need depth images"});
  expect_failed(calibrate({"--frames", "0:1"}), {"3 frames"});
  edit_file(path("in/recording.yaml"), "parent: base_link", "parent: wrist_1_link");
  expect_failed(calibrate({}), {"a camera that stands still, and wrist_1_link moves"});
  edit_file(path("in/recording.yaml"), "parent: wrist_1_link", "parent: base_link");

  // The camera shows a still picture while the joints move, then images of another size.
  for (const auto& file : fs::directory_iterator(path("in/color")))
    if (file.path().filename() != "0.png")
      fs::copy_file(path("in/color/0.png"), file.path(), fs::copy_options::overwrite_existing);
  expect_failed(calibrate({"-o", out()}), {"do not show the robot move as its joints say"});
  EXPECT_FALSE(fs::exists(out("camera_pose.csv")));
  Image<Rgb8> small(64, 48);
  io::write_png(path("in/color/1.png"), std::as_const(small).view());
  expect_has(calibrate({}).err, {"has 64 x 48 pixels"});
}

/// Real webcams with strong lenses; a board on the flange, whose corners gave the pose, is not in
/// the URDF. Four images of the second are of another view.
TEST(CalibrateWebcam, FindsThePoseOfTheBoard) {
  PENUMBRA_REQUIRE_DATA();
  const fs::path webcam = data_folder() / "ur3e_webcam_4";
  TemporaryFolder folder;
  const Isometry3d board = io::read_pose_csv(webcam / "board_pose.csv");
  Isometry3d off = board;
  off.translation() += Vector3d(0.05, -0.06, 0.05);
  off.linear() = off.linear() * Eigen::AngleAxisd(0.15, Vector3d(1, 2, -1).normalized()).matrix();
  io::write_pose_csv(folder.path() / "off.csv", off);
  const Outcome outcome =
      succeed(penumbra({"calibrate", webcam, "--images", "--initial", folder.path() / "off.csv",
                        "-o", folder.path() / "out"}));
  expect_has(outcome.err, {"frame 15 is left out"});
  constexpr double near = 0.006;  // metres; the board's pose is good to one or two millimetres
  EXPECT_LT(metres_between(io::read_pose_csv(folder.path() / "out/camera_pose.csv"), board), near);
}

/// The same camera is given elsewhere, and right.
TEST(CalibrateWebcam, AWrongPoseIsNamedByTheImages) {
  PENUMBRA_REQUIRE_DATA();
  TemporaryFolder folder;
  const fs::path webcam = folder.path() / "webcam", out = folder.path() / "out";
  fs::copy(data_folder() / "ur3e_webcam_1", webcam);
  edit_file(webcam / "recording.yaml", "urdf: ..", "urdf: " + data_folder().string());
  edit_file(webcam / "recording.yaml", "ur_description: ..",
            "ur_description: " + data_folder().string());
  const auto cause = [&] {
    succeed(penumbra({"run", webcam, "-o", out, "--save", "labels", "--force"}));
    const Json summary = read_json(out / "report.json")["summary"];
    EXPECT_EQ(summary["compared_poses"], 20);
    return summary["diagnosis"].is_null() ? Json() : summary["diagnosis"]["cause"];
  };
  EXPECT_EQ(cause(), Json());
  const Isometry3d right = io::read_pose_csv(webcam / "board_pose.csv");
  Isometry3d off = right;
  off.translation() += Vector3d(0.03, -0.03, 0.02);
  io::write_pose_csv(webcam / "board_pose.csv", off);
  EXPECT_EQ(cause(), "camera_pose");
  io::write_pose_csv(webcam / "board_pose.csv", right.inverse());
  EXPECT_EQ(cause(), "camera_inverted");
}

using CalibrateOfAnUnknownCamera = FolderTest;

TEST_F(CalibrateOfAnUnknownCamera, IsSearchedFor) {
  fs::copy(example, path("in"), fs::copy_options::recursive);
  edit_file(path("in/recording.yaml"), "  parent: base_link", "  #");
  edit_file(path("in/recording.yaml"), "  pose: camera_pose.csv", "  #");
  for (const char* command : {"run", "calibrate"}) {
    expect_failed(penumbra({command, path("in"), "-o", path("no")}), {"calibrate --search"});
  }
  succeed(penumbra({"calibrate", path("in"), "--search", "-o", out()}));
  constexpr double near = 0.003;  // metres; docs/calibration.md: the robot moves in most frames
  EXPECT_LT(metres_between(io::read_pose_csv(out("camera_pose.csv")),
                           io::read_pose_csv(example / "camera_pose.csv")),
            near);
}

/// What run, tune and calibrate say of a real recording whose setup is wrong.
class DiagnosisTest : public RealRecording {
 protected:
  void spoil(const std::function<Eigen::Isometry3d(Eigen::Isometry3d)>& change) {
    const fs::path pose = path("recording/camera_pose.csv");
    io::write_pose_csv(pose, change(io::read_pose_csv(pose)));
  }
  /// Runs and expects this status and cause; null: none.
  Outcome expect_cause(int status, const Json& cause) {
    const Outcome outcome = run("out");
    EXPECT_EQ(outcome.status, status) << outcome.err;
    const Json diagnosis = report()["summary"]["diagnosis"];
    EXPECT_EQ(diagnosis.is_null() ? diagnosis : diagnosis["cause"], cause) << diagnosis;
    return outcome;
  }
};

TEST_F(DiagnosisTest, AnInvertedPoseEndsWithStatus2) {
  spoil([](const Eigen::Isometry3d& T) { return T.inverse(); });
  expect_lacks(expect_cause(2, "camera_inverted").out, {" 0 bad"});
  succeed(run("out", {"--force"}));
}

TEST_F(DiagnosisTest, TuneRefusesAWrongPose) {
  spoil([](Eigen::Isometry3d T) { return T.translation().x() += 0.05, T; });
  expect_cause(0, "camera_pose");
  expect_failed(penumbra({"tune", path("recording"), "-o", path("tuned")}), {"penumbra calibrate"});
  EXPECT_FALSE(fs::exists(path("tuned")));
}

TEST_F(DiagnosisTest, DepthScaleMendsDepthOfAnotherUnit) {
  const auto refused = [](const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 2);
    expect_has(outcome.err, {"depth_scale"});
  };
  expect_cause(0, nullptr);
  edit_file(path("recording/recording.yaml"), "  pose:", "  depth_scale: 0.01\n  pose:");
  expect_cause(2, "depth_unit");
  refused(penumbra({"calibrate", path("recording")}));
  edit_file(path("recording/recording.yaml"), "0.01\n", "0.001\n");
  expect_cause(0, nullptr);
  edit_file(path("recording/recording.yaml"), "0.001\n", "0\n");
  refused(run("out"));
}

TEST_F(DiagnosisTest, NormalisedDepthAndDepthAlongTheRay) {
  const Camera camera = io::read_camera_info(path("recording/camera_info.yaml"), false);
  const auto write_depth = [&](const std::function<double(double z, double ray)>& given) {
    for (std::size_t i = 0; i < 10; ++i) {
      const std::string name = "recording/depth_" + std::to_string(i);
      const auto read = read_image<std::uint16_t>(path(name + ".png"));
      Image<float> depth(read.width(), read.height());
      for (int v = 0; v < read.height(); ++v)
        for (int u = 0; u < read.width(); ++u)
          depth(u, v) =
              static_cast<float>(given(0.001 * read(u, v), camera.intrinsics.ray(u, v).norm()));
      io::write_npy(path(name + ".npy"), depth.view());
    }
  };
  const fs::path yaml = path("recording/recording.yaml");
  edit_file(yaml, "depth_%d.png", "depth_%d.npy");
  write_depth([](double z, double) { return std::min(z / 4.0, 1.0); });
  expect_has(expect_cause(0, "depth_scale").err, {"depth_scale"});
  write_depth([](double z, double ray) { return z * ray; });
  expect_has(expect_cause(0, "depth_ray").err, {"set depth_along to ray"});
  edit_file(yaml, "  pose:", "  depth_along: ray\n  pose:");
  expect_cause(0, nullptr);
}

}  // namespace
}  // namespace penumbra::test
