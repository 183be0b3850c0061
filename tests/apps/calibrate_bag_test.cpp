// SPDX-License-Identifier: Apache-2.0
// penumbra calibrate on bags whose tf places the camera, against the pose that was rendered.
#include "../support/run_length.hpp"
#include "real_recording.hpp"

#include <cmath>
#include <numbers>

namespace penumbra::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// docs/calibration.md: what folders with these images reach while the robot moves in most frames.
constexpr double near_metres = 0.003, near_degrees = 0.15;

double degrees_between(const Isometry3d& a, const Isometry3d& b) {
  const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
  return std::abs(turn.angle()) * 180.0 / std::numbers::pi;
}

class CalibrateBagTest : public RecordingTest {
 protected:
  /// Calls a command; options of bags are added for a bag.
  Outcome call(const std::string& command, const std::string& input, const std::string& output,
               const Words& options = {}) const {
    return penumbra(Words{command, path(input), "-o", path(output)} + options +
                    (input.ends_with(".mcap") ? example_package : Words{}));
  }
  [[nodiscard]] Isometry3d found(const std::string& output) const {
    return io::read_pose_csv(path(output) / "camera_pose.csv");
  }
  /// 65 mm and 4 degrees off.
  [[nodiscard]] Isometry3d wrong() const { return off(truth_, {0.03, -0.04, 0.042}, 0.07); }

  /// A bag of the recording with the pose off gives the truth. Returns what is said of the bag.
  Outcome expect_found() const {
    recording_bag(path("recording"), wrong()).write_mcap(path("off.mcap"));
    Outcome outcome = succeed(call("calibrate", "off.mcap", "bag"));
    EXPECT_LT(metres_between(found("bag"), truth_), near_metres);
    EXPECT_LT(degrees_between(found("bag"), truth_), near_degrees);
    return outcome;
  }

  Isometry3d truth_ = io::read_pose_csv(example / "camera_pose.csv");
};

using CalibrateExampleBag = CalibrateBagTest;

TEST_F(CalibrateExampleBag, BringsBackACameraInTheCell) {
  fs::copy(example, path("recording"), fs::copy_options::recursive);
  const fs::path pose = path("bag/camera_pose.csv");
  expect_has(expect_found().out, {"--pose " + pose.string() + " --parent base_link",
                                  "--frame-id base_link --child-frame-id camera_optical_frame"});
  // With these options `run` shows the robot where it is.
  expect_has(call("run", "off.mcap", "a").err, {"penumbra calibrate"});
  expect_lacks(succeed(call("run", "off.mcap", "b", {"--pose", pose, "--parent", "base_link"})).err,
               {"penumbra calibrate"});
}

TEST_F(CalibrateExampleBag, SaysHowFarTfIsFromWhatAGuessGives) {
  for (const auto& [pose, says] : {std::pair(wrong(), "beyond that"), {truth_, "within that"}}) {
    recording_bag(example, pose).write_mcap(path("bag.mcap"));
    expect_has(succeed(call("calibrate", "bag.mcap", "out", initial(truth_))).err,
               {"tf's pose is", says});
  }
}

/// The second camera stands where the first does, and TF says so of the first alone.
TEST_F(CalibrateExampleBag, OfTwoCamerasTakesTheOneThatIsNamed) {
  TinyBag bag = recording_bag(example, wrong());
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
      options = options + initial(wrong());
    }
    succeed(call("calibrate", "two.mcap", "out", options));
    EXPECT_LT(metres_between(found("out"), truth_), near_metres) << topic;
  }
}

/// The shared bag of a real robot, whose tf has the published pose of the camera.
using CalibrateSharedBag = CalibrateBagTest;

TEST_F(CalibrateSharedBag, StartsFromTfAGuessOrNothing) {
  PENUMBRA_REQUIRE_DATA();
  constexpr double near_published = 0.015;  // metres: the folder's own result lies 12 mm from it
  const fs::path folder = data_folder() / "xarm7_realsense";
  truth_ = io::read_pose_csv(folder / "camera_pose.csv");
  std::vector<Words> ways{{}, initial(wrong())};
  if (is_full_run()) ways.push_back({"--search", "--parent", "link_base"});  // half a minute
  for (const Words& options : ways) {
    succeed(penumbra(Words{"calibrate", folder / "xarm7.mcap", "-o", out()} + xarm_package() +
                     options));
    EXPECT_LT(metres_between(found("out"), truth_), near_published) << options.size();
  }
}

/// The camera is next to the gripper and looks at the arm, as the wrist looks back; the images are
/// rendered.
TEST_F(CalibrateBagTest, BringsBackACameraOnTheArm) {
  truth_ = Eigen::Translation3d(0.0, -0.16, -0.12) * Eigen::AngleAxisd(-0.5, Vector3d::UnitX());
  fs::copy(example, path("recording"), fs::copy_options::recursive);
  edit("parent: base_link", "parent: flange");
  edit("  color: color/%d.png", "");
  edit("depth/%d.png", "depth/%d.npy");
  const fs::path pose = path("recording/camera_pose.csv");
  io::write_pose_csv(pose, truth_);
  const Words joints{"shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"};
  const std::vector<double> looking_back{0.0, 0.3, 1.2, 1.6, 0.4, 0.3};
  std::string rows = "frame,stamp," + joined(joints) + ",gripper_left\n";
  for (int frame = 0; frame < 10; ++frame) {
    const std::string number = std::to_string(frame);
    Words line = split("render --parent flange --robot") +
                 Words{example / "arm_description/arm.urdf", "-o",
                       path("recording/depth/" + number + ".npy")} +
                 Words{"--camera", example / "camera_info.yaml", "--pose", pose} + example_package;
    Words values;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const double swing = 0.35 * std::sin(1.7 * frame + 2.1 * static_cast<double>(i));
      values.push_back(std::to_string(looking_back[i] + swing));
      line = line + Words{"--joint", joints[i] + "=" + values.back()};
    }
    succeed(penumbra(line));
    rows += number + "," + std::to_string(1'000'000'000LL * (frame + 1)) + "," + joined(values) +
            ",0.01\n";
  }
  write("recording/joint_states.csv", rows);
  expect_found();
}

}  // namespace
}  // namespace penumbra::test
