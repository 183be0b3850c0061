// SPDX-License-Identifier: Apache-2.0
// penumbra calibrate on bags whose tf places the camera, against the pose that was rendered.
#include "../support/data.hpp"
#include "fixtures.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <io/files/pose_file.hpp>

namespace penumbra::test {
namespace {

// docs/calibration.md: what folders with these images reach while the robot moves in most frames.
constexpr double near_mm = 3.0, near_degrees = 0.15;
// A bag and a folder with the same frames give the same numbers, up to single pixels of edges.
constexpr double same_mm = 0.1, same_degrees = 0.01;

double mm_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return 1e3 * (a.translation() - b.translation()).norm();
}
double degrees_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
  return std::abs(turn.angle()) * 180.0 / std::numbers::pi;
}

/// Returns the pose 65 mm and 4 degrees off.
Eigen::Isometry3d off(Eigen::Isometry3d pose) {
  pose.translation() += Eigen::Vector3d(0.03, -0.04, 0.042);
  pose.linear() =
      pose.linear() * Eigen::AngleAxisd(0.07, Eigen::Vector3d(1, 2, -1).normalized()).matrix();
  return pose;
}

class CalibrateBagTest : public FolderTest {
 protected:
  /// Calls a command; options of bags are added for a bag.
  Outcome call(const std::string& command, const std::string& input, const std::string& output,
               const Words& options = {}) const {
    const bool is_bag = input.ends_with(".mcap");
    return penumbra(Words{command, path(input), "-o", path(output)} + options +
                    (is_bag ? example_package : Words{}));
  }
  [[nodiscard]] Eigen::Isometry3d found(const std::string& output) const {
    return io::read_pose_csv(path(output) / "camera_pose.csv");
  }

  /// A bag of the recording and the recording itself, both with the pose off, give the truth.
  /// Returns what is said of the bag.
  Outcome expect_both_find(const std::string& recording, const Eigen::Isometry3d& truth) const {
    const Eigen::Isometry3d wrong = off(truth);
    EXPECT_GT(mm_between(wrong, truth), 60.0);
    recording_bag(path(recording), wrong).write_mcap(path("off.mcap"));
    io::write_pose_csv(path("off.csv"), wrong);
    Outcome of_bag = succeed(call("calibrate", "off.mcap", "bag"));
    succeed(call("calibrate", recording, "folder", {"--initial", path("off.csv")}));
    for (const char* of : {"bag", "folder"}) {
      EXPECT_LT(mm_between(found(of), truth), near_mm) << of;
      EXPECT_LT(degrees_between(found(of), truth), near_degrees) << of;
    }
    EXPECT_LT(mm_between(found("bag"), found("folder")), same_mm);
    EXPECT_LT(degrees_between(found("bag"), found("folder")), same_degrees);
    return of_bag;
  }
};

class CalibrateExampleBag : public CalibrateBagTest {
 protected:
  const Eigen::Isometry3d truth_ = io::read_pose_csv(example / "camera_pose.csv");
};

TEST_F(CalibrateExampleBag, BringsBackACameraInTheCell) {
  fs::copy(example, path("example"), fs::copy_options::recursive);
  const fs::path pose = path("bag/camera_pose.csv");
  expect_has(expect_both_find("example", truth_).out,
             {"--pose " + pose.string() + " --parent base_link",
              "--frame-id base_link --child-frame-id camera_optical_frame"});
  // With these options `run` shows the robot where it is.
  expect_has(call("run", "off.mcap", "a").err, {"penumbra calibrate"});
  expect_lacks(succeed(call("run", "off.mcap", "b", {"--pose", pose, "--parent", "base_link"})).err,
               {"penumbra calibrate"});
}

TEST_F(CalibrateExampleBag, NeedsNoPoseInTheBagWithAGuess) {
  TinyBag bag = recording_bag(example, truth_);
  bag.remove("/tf_static");
  bag.write_mcap(path("bare.mcap"));
  io::write_pose_csv(path("off.csv"), off(truth_));
  succeed(call("calibrate", "bare.mcap", "bare", {"--initial", path("off.csv")}));
  EXPECT_LT(mm_between(found("bare"), truth_), near_mm);
}

TEST_F(CalibrateExampleBag, SaysHowFarTfIsFromWhatAGuessGives) {
  recording_bag(example, off(truth_)).write_mcap(path("off.mcap"));
  const Words guess{"--initial", (example / "camera_pose.csv").string()};
  expect_has(succeed(call("calibrate", "off.mcap", "out", guess)).err,
             {"tf's pose is", "beyond that"});
  recording_bag(example, truth_).write_mcap(path("right.mcap"));
  expect_has(succeed(call("calibrate", "right.mcap", "same", guess)).err,
             {"tf's pose is", "within that"});
}

/// The second camera stands where the first does, and TF says so of the first alone.
TEST_F(CalibrateExampleBag, OfTwoCamerasTakesTheOneThatIsNamed) {
  TinyBag bag = recording_bag(example, off(truth_));
  bag.copy("/camera/depth/image", "/second/depth/image");
  bag.copy("/camera/depth/camera_info", "/second/depth/camera_info");
  bag.edit<io::ImageMessage>("/second/depth/image",
                             [](auto& image) { image.header.frame_id = "second_optical_frame"; });
  bag.edit<io::CameraInfoMessage>("/second/depth/camera_info", [](auto& info) {
    info.header.frame_id = "second_optical_frame";
  });
  bag.write_mcap(path("two.mcap"));
  for (const std::string topic : {"/camera/depth/image", "/second/depth/image"}) {
    Words options{"--depth-topic", topic};
    if (topic.starts_with("/second")) {
      expect_refused(call("calibrate", "two.mcap", "out", options), {"second_optical_frame"});
      options = options + Words{"--initial", (example / "camera_pose.csv").string()};
    }
    succeed(call("calibrate", "two.mcap", "out", options));
    EXPECT_LT(mm_between(found("out"), truth_), near_mm) << topic;
  }
}

TEST_F(CalibrateExampleBag, RefusesACameraThatTfMoves) {
  TinyBag bag = recording_bag(example, truth_);
  bag.remove("/tf_static");
  const std::int64_t begin = bag.messages.front().log_time;
  for (int i = 0; i < 13; ++i) {
    Eigen::Isometry3d pose = truth_;
    pose.translation().x() += 0.01 * i;
    const std::int64_t stamp = begin + i * 100'000'000;
    bag.add("/tf", stamp, io::TfMessage{{{{stamp, "base_link"}, "camera_optical_frame", pose}}});
  }
  bag.sort();
  bag.write_mcap(path("moving.mcap"));
  expect_refused(call("calibrate", "moving.mcap", "out"),
                 {"moving.mcap: frame 1", "the camera moves", "--frames"});
  EXPECT_FALSE(fs::exists(path("out/camera_pose.csv")));
}

/// The shared bag of a real robot, whose tf has the published pose of the camera.
using CalibrateSharedBag = CalibrateBagTest;

TEST_F(CalibrateSharedBag, StartsFromTfAGuessOrNothing) {
  PENUMBRA_REQUIRE_DATA();
  constexpr double near_published_mm = 15.0;  // the folder's own result lies 12 mm from it
  const fs::path folder = data_folder() / "xarm7_realsense";
  const Eigen::Isometry3d published = io::read_pose_csv(folder / "camera_pose.csv");
  io::write_pose_csv(path("off.csv"), off(published));
  const Words package{
      "--package",
      "xarm_description=" + fs::absolute(data_folder() / "robots/xarm7/xarm_description").string()};
  std::vector<Words> ways{{}, {"--initial", path("off.csv")}};
  if (is_full_run()) ways.push_back({"--search", "--parent", "link_base"});  // half a minute
  for (const Words& options : ways) {
    succeed(
        penumbra(Words{"calibrate", folder / "xarm7.mcap", "-o", path("out")} + package + options));
    EXPECT_LT(mm_between(found("out"), published), near_published_mm) << options.size();
  }
}

/// A camera next to the gripper, which looks at the arm; the images are rendered.
class CalibrateHandBag : public CalibrateBagTest {
 protected:
  CalibrateHandBag() {
    truth_.translation() = Eigen::Vector3d(0.0, -0.16, -0.12);
    truth_.linear() = Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitX()).matrix();
    fs::create_directory(path("hand"));
    io::write_pose_csv(path("hand/pose.csv"), truth_);
    write_file(path("hand/recording.yaml"),
               "robot:\n  urdf: " + (example / "arm_description/arm.urdf").string() +
                   "\n  packages: {arm_description: " + (example / "arm_description").string() +
                   "}\ncamera: {info: camera_info.yaml, parent: flange, pose: pose.csv}\n"
                   "frames: {joints: joints.csv, depth: depth_%d.npy}\n");
    fs::copy(example / "camera_info.yaml", path("hand/camera_info.yaml"));
    std::string rows = "frame,stamp," + joined(joints_) + ",gripper_left\n";
    for (int i = 0; i < poses; ++i) rows += render(i);
    write_file(path("hand/joints.csv"), rows);
  }

  static std::string joined(const Words& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
    return text;
  }

  /// Renders a frame and returns its row of joints. The wrist looks back at the arm.
  std::string render(int frame) {
    Words options = Words{"render",
                          "--robot",
                          example / "arm_description/arm.urdf",
                          "--camera",
                          path("hand/camera_info.yaml"),
                          "--pose",
                          path("hand/pose.csv"),
                          "--parent",
                          "flange",
                          "-o",
                          path("hand/depth_" + std::to_string(frame) + ".npy")} +
                    example_package;
    Words values;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double swing = 0.35 * std::sin(1.7 * frame + 2.1 * static_cast<double>(i));
      values.push_back(std::to_string(looking_back_[i] + swing));
      options.insert(options.end(), {"--joint", joints_[i] + "=" + values.back()});
    }
    succeed(penumbra(options));
    return std::to_string(frame) + "," + std::to_string(1'000'000'000LL * (frame + 1)) + "," +
           joined(values) + ",0.01\n";
  }

  static constexpr int poses = 10;
  const Words joints_{"shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"};
  const std::vector<double> looking_back_{0.0, 0.3, 1.2, 1.6, 0.4, 0.3};
  Eigen::Isometry3d truth_ = Eigen::Isometry3d::Identity();
};

TEST_F(CalibrateHandBag, BringsBackACameraOnTheArm) { expect_both_find("hand", truth_); }

}  // namespace
}  // namespace penumbra::test
