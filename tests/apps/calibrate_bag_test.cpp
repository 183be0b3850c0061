// SPDX-License-Identifier: Apache-2.0
// penumbra calibrate on bags whose tf places the camera, against the pose that was rendered.
#include "fixtures.hpp"
#include "recording_bag.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <io/files/pose_file.hpp>

namespace penumbra::test {
namespace {

// docs/calibration.md: what folders with these images reach while the robot moves in most frames.
constexpr double near_mm = 3.0, near_degrees = 0.15;
// A bag and a folder with the same frames give the same numbers.
constexpr double same_mm = 1e-3, same_degrees = 1e-3;

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

class CalibrateBagTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// Calibrates an input into a folder; options of bags are added for a bag.
  Outcome calibrate(const std::string& input, const std::string& output, Words options = {}) const {
    options.insert(options.begin(), {"calibrate", path(input), "-o", path(output)});
    return penumbra(with_packages(input, options));
  }
  [[nodiscard]] Words with_packages(const std::string& input, Words options) const {
    if (input.ends_with(".mcap"))
      options.insert(options.end(),
                     {"--package", "arm_description=" + (example_ / "arm_description").string()});
    return options;
  }
  [[nodiscard]] Eigen::Isometry3d found(const std::string& output) const {
    return io::read_pose_csv(path(output) / "camera_pose.csv");
  }

  /// A bag of the recording and the recording itself, both with the pose off, give the truth.
  void expect_both_find(const std::string& recording, const Eigen::Isometry3d& truth) const {
    const Eigen::Isometry3d wrong = off(truth);
    ASSERT_GT(mm_between(wrong, truth), 60.0);
    recording_bag(path(recording), wrong).write_mcap(path("off.mcap"));
    io::write_pose_csv(path("off.csv"), wrong);
    for (const Words& given : {Words{"off.mcap", "bag"}, Words{recording, "folder"}}) {
      const Outcome outcome = calibrate(
          given[0], given[1], given[1] == "bag" ? Words{} : Words{"--initial", path("off.csv")});
      ASSERT_EQ(outcome.status, 0) << given[0] << ": " << outcome.err;
      EXPECT_LT(mm_between(found(given[1]), truth), near_mm) << given[0];
      EXPECT_LT(degrees_between(found(given[1]), truth), near_degrees) << given[0];
    }
    EXPECT_LT(mm_between(found("bag"), found("folder")), same_mm);
    EXPECT_LT(degrees_between(found("bag"), found("folder")), same_degrees);
  }

  const fs::path example_ = fs::path(PENUMBRA_SOURCE_DIR) / "examples/arm_over_table";
  TemporaryFolder folder_;
};

class CalibrateExampleBag : public CalibrateBagTest {
 protected:
  CalibrateExampleBag() { fs::copy(example_, path("example"), fs::copy_options::recursive); }
  const Eigen::Isometry3d truth_ = io::read_pose_csv(example_ / "camera_pose.csv");
};

TEST_F(CalibrateExampleBag, BringsBackACameraInTheCell) { expect_both_find("example", truth_); }

TEST_F(CalibrateExampleBag, PrintsOptionsWithWhichRunShowsTheRobotWhereItIs) {
  recording_bag(path("example"), off(truth_)).write_mcap(path("off.mcap"));
  const Outcome before =
      penumbra(with_packages("off.mcap", {"run", path("off.mcap"), "-o", path("a")}));
  expect_has(before.err, {"penumbra calibrate"});
  const Outcome outcome = calibrate("off.mcap", "found");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const fs::path pose = path("found/camera_pose.csv");
  expect_has(outcome.out, {"--pose " + pose.string() + " --parent base_link",
                           "--frame-id base_link --child-frame-id camera_optical_frame"});
  const Outcome after =
      penumbra(with_packages("off.mcap", {"run", path("off.mcap"), "-o", path("b"), "--pose", pose,
                                          "--parent", "base_link"}));
  EXPECT_EQ(after.status, 0);
  EXPECT_EQ(after.err.find("penumbra calibrate"), std::string::npos) << after.err;
}

TEST_F(CalibrateExampleBag, NeedsNoPoseInTheBagWithAGuess) {
  TinyBag bag = recording_bag(path("example"), truth_);
  bag.remove("/tf_static");
  bag.write_mcap(path("bare.mcap"));
  io::write_pose_csv(path("off.csv"), off(truth_));
  const Outcome refused = calibrate("bare.mcap", "none");
  expect_refused(refused, {"bare.mcap", "has no tf", "--pose"});
  for (const Words& options : {Words{"--initial", path("off.csv")},
                               Words{"--pose", path("off.csv"), "--parent", "base_link"}}) {
    const Outcome outcome = calibrate("bare.mcap", "bare", options);
    ASSERT_EQ(outcome.status, 0) << options[0] << ": " << outcome.err;
    EXPECT_LT(mm_between(found("bare"), truth_), near_mm) << options[0];
  }
}

TEST_F(CalibrateExampleBag, RefusesACameraThatTfMoves) {
  TinyBag bag = recording_bag(path("example"), truth_);
  bag.remove("/tf_static");
  const std::int64_t begin = bag.messages.front().log_time;
  for (int i = 0; i < 13; ++i) {
    Eigen::Isometry3d pose = truth_;
    pose.translation().x() += 0.01 * i;
    const std::int64_t stamp = begin + i * 100'000'000;
    bag.add("/tf", stamp, io::TfMessage{{{{stamp, "base_link"}, "camera_optical_frame", pose}}});
  }
  std::stable_sort(bag.messages.begin(), bag.messages.end(),
                   [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
  bag.write_mcap(path("moving.mcap"));
  expect_refused(calibrate("moving.mcap", "out"),
                 {"moving.mcap: frame 1", "tf moves the camera", "base_link", "--frames"});
  EXPECT_FALSE(fs::exists(path("out/camera_pose.csv")));
}

/// A camera next to the gripper, which looks at the arm; the images are rendered.
class CalibrateHandBag : public CalibrateBagTest {
 protected:
  CalibrateHandBag() {
    truth_.translation() = Eigen::Vector3d(0.0, -0.16, -0.12);
    truth_.linear() = Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitX()).matrix();
    fs::create_directory(path("hand"));
    io::write_pose_csv(path("hand/pose.csv"), truth_);
    const std::string urdf = example_ / "arm_description/arm.urdf";
    write_file(path("hand/recording.yaml"),
               "robot:\n  urdf: " + urdf +
                   "\n  packages: {arm_description: " + (example_ / "arm_description").string() +
                   "}\ncamera: {info: camera_info.yaml, parent: flange, pose: pose.csv}\n"
                   "frames: {joints: joints.csv, depth: depth_%d.npy}\n");
    fs::copy(example_ / "camera_info.yaml", path("hand/camera_info.yaml"));
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
    Words options = {"render",
                     "--robot",
                     example_ / "arm_description/arm.urdf",
                     "--package",
                     "arm_description=" + (example_ / "arm_description").string(),
                     "--camera",
                     path("hand/camera_info.yaml"),
                     "--pose",
                     path("hand/pose.csv"),
                     "--parent",
                     "flange",
                     "-o",
                     path("hand/depth_" + std::to_string(frame) + ".npy")};
    Words values;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double swing = 0.35 * std::sin(1.7 * frame + 2.1 * static_cast<double>(i));
      values.push_back(std::to_string(looking_back_[i] + swing));
      options.insert(options.end(), {"--joint", joints_[i] + "=" + values.back()});
    }
    EXPECT_EQ(penumbra(options).status, 0);
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
