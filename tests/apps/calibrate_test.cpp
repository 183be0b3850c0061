// SPDX-License-Identifier: Apache-2.0
// penumbra calibrate on a real recording, and on what it must refuse.
#include "../support/data.hpp"
#include "../support/page_json.hpp"
#include "fixtures.hpp"

#include <Eigen/Geometry>

#include <io/files/pose_file.hpp>

namespace penumbra::test {
namespace {

class CalibrateTest : public testing::Test {
 protected:
  void SetUp() override { PENUMBRA_REQUIRE_DATA(); }

  [[nodiscard]] fs::path recording() const { return data_folder() / "xarm7_realsense"; }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  Outcome calibrate(std::vector<std::string> options) const {
    options.insert(options.begin(), {"calibrate", recording()});
    return penumbra(options);
  }

  /// Writes the recording's own pose, moved by some centimetres and turned.
  [[nodiscard]] fs::path pose_off() const {
    Eigen::Isometry3d pose = io::read_pose_csv(recording() / "camera_pose.csv");
    pose.translation() += Eigen::Vector3d(0.05, -0.06, 0.05);
    pose.linear() =
        pose.linear() * Eigen::AngleAxisd(0.15, Eigen::Vector3d(1, 2, -1).normalized()).matrix();
    io::write_pose_csv(path("off.csv"), pose);
    return path("off.csv");
  }

  TemporaryFolder folder_;
};

TEST_F(CalibrateTest, StartsDoNotMatter) {
  ASSERT_EQ(calibrate({"-o", path("a")}).status, 0);
  ASSERT_EQ(calibrate({"--initial", pose_off(), "-o", path("b")}).status, 0);
  const Eigen::Isometry3d a = io::read_pose_csv(path("a/camera_pose.csv"));
  const Eigen::Isometry3d b = io::read_pose_csv(path("b/camera_pose.csv"));
  constexpr double same = 0.002;  // metres; docs/calibration.md
  EXPECT_LT((a.translation() - b.translation()).norm(), same);
  const Eigen::Isometry3d published = io::read_pose_csv(recording() / "camera_pose.csv");
  const Json json = Json::parse(read_file(path("a/calibration.json")));
  EXPECT_LT((a.translation() - published.translation()).norm(),
            1.5 * json["position_error_95_m"].get<double>());
  EXPECT_TRUE(json["link_residuals_m"].contains("link7"));
  const std::string page = read_file(path("a/report.html"));
  EXPECT_EQ(page_json(page, "penumbra-report"), json);
  EXPECT_EQ(page_json(page, "penumbra-pictures")[1]["caption"], "frame 0, result");
}

TEST_F(CalibrateTest, MasksGiveTheColourImagesPose) {
  ASSERT_EQ(calibrate({"--masks", "robot_mask_%d.png", "-o", path("a")}).status, 0);
  const Json json = Json::parse(read_file(path("a/calibration.json")));
  EXPECT_GT(json["masks"]["overlap"], 0.926) << "that of the published pose";
}

/// The shipped recording without depth, with the masks that `run` writes of it.
class CalibrateMasksTest : public testing::Test {
 protected:
  CalibrateMasksTest() {
    fs::copy(example, path("masked"), fs::copy_options::recursive);
    EXPECT_EQ(
        penumbra({"run", path("masked"), "-o", path("masked/out"), "--save", "robot_mask"}).status,
        0);
    edit_file(path("masked/recording.yaml"), "  depth: depth/%d.png", "");
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  Outcome calibrate(std::vector<std::string> options) const {
    options.insert(options.begin(), {"calibrate", path("masked")});
    return penumbra(options);
  }

  const fs::path example = fs::path(PENUMBRA_SOURCE_DIR) / "examples/arm_over_table";
  TemporaryFolder folder_;
};

TEST_F(CalibrateMasksTest, FindsThePoseOfTheMasks) {
  const Eigen::Isometry3d truth = io::read_pose_csv(example / "camera_pose.csv");
  Eigen::Isometry3d off = truth;
  off.translation() += Eigen::Vector3d(0.04, -0.05, 0.05);
  io::write_pose_csv(path("off.csv"), off);
  const Outcome outcome = calibrate(
      {"--masks", "out/robot_mask/%06d.png", "--initial", path("off.csv"), "-o", path("found")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("overlap with the masks"), std::string::npos) << outcome.out;
  const Eigen::Isometry3d found = io::read_pose_csv(path("found/camera_pose.csv"));
  constexpr double limit = 0.002;  // metres: exact masks of poses that are near each other
  EXPECT_LT((found.translation() - truth.translation()).norm(), limit);
  const Json json = Json::parse(read_file(path("found/calibration.json")));
  EXPECT_TRUE(json["depth_offset_m"].is_null());
  EXPECT_GT(json["masks"]["overlap"], 0.99);
  EXPECT_EQ(page_json(read_file(path("found/report.html")), "penumbra-report"), json);
}

TEST_F(CalibrateMasksTest, LeavesOutFramesWithoutAMaskAndRefusesWhatNeedsDepth) {
  fs::remove(path("masked/out/robot_mask/000002.png"));
  const Outcome outcome = calibrate({"--masks", "out/robot_mask/%06d.png"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("frames without a mask are left out: 1"), std::string::npos)
      << outcome.err;
  for (const char* option : {"--joint-offsets", "--time-offset"}) {
    const Outcome refused = calibrate({"--masks", "out/robot_mask/%06d.png", option});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("need depth images"), std::string::npos) << refused.err;
  }
  const Outcome none = calibrate({});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("--masks"), std::string::npos) << none.err;
  const Outcome wrong = calibrate({"--masks", "color/%d.png"});
  EXPECT_EQ(wrong.status, 2);
}

TEST_F(CalibrateTest, RefusesTooFewFramesAndOtherRobots) {
  const Outcome few = calibrate({"--frames", "0:2"});
  EXPECT_EQ(few.status, 2);
  EXPECT_NE(few.err.find("3 frames"), std::string::npos) << few.err;
  EXPECT_EQ(calibrate({"--masks", "none_%d.png"}).status, 2);
  EXPECT_EQ(calibrate({"--search", "--initial", pose_off()}).status, 2);

  fs::copy(recording(), path("other"), fs::copy_options::recursive);
  const fs::path robots = fs::absolute(data_folder() / "robots");
  edit_file(path("other/recording.yaml"), "../robots/xarm7/xarm7.urdf",
            robots / "xarm7/xarm7.urdf");
  edit_file(path("other/recording.yaml"), "../robots/xarm7/xarm_description",
            robots / "xarm7/xarm_description");
  // The joints of other frames: the robot is elsewhere than they say.
  std::string joints = read_file(path("other/joint_states.csv"));
  std::vector<std::string> rows;
  for (std::size_t at = 0, end; at < joints.size(); at = end + 1) {
    end = std::min(joints.find('\n', at), joints.size());
    rows.push_back(joints.substr(at, end - at));
  }
  std::string turned = rows[0] + "\n";
  for (std::size_t i = 1; i < 11; ++i)
    turned += rows[i].substr(0, rows[i].find(',')) +
              rows[1 + i % 10].substr(rows[1 + i % 10].find(',')) + "\n";
  write_file(path("other/joint_states.csv"), turned);
  const Outcome other = penumbra({"calibrate", path("other"), "-o", path("out")});
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("not calibrated"), std::string::npos) << other.err;
  EXPECT_FALSE(fs::exists(path("out/camera_pose.csv")));
}

TEST(CalibrateOfAnUnknownCamera, IsSearchedFor) {
  const TemporaryFolder folder;
  const fs::path example = fs::path(PENUMBRA_SOURCE_DIR) / "examples/arm_over_table";
  fs::copy(example, folder.path() / "in", fs::copy_options::recursive);
  edit_file(folder.path() / "in/recording.yaml", "  parent: base_link", "  #");
  edit_file(folder.path() / "in/recording.yaml", "  pose: camera_pose.csv", "  #");
  for (const char* command : {"run", "calibrate"}) {
    const Outcome refused = penumbra({command, folder.path() / "in", "-o", folder.path() / "no"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("calibrate --search"), std::string::npos) << refused.err;
  }
  const fs::path out = folder.path() / "out";
  ASSERT_EQ(penumbra({"calibrate", folder.path() / "in", "--search", "-o", out}).status, 0);
  const Eigen::Isometry3d truth = io::read_pose_csv(example / "camera_pose.csv");
  const Eigen::Isometry3d found = io::read_pose_csv(out / "camera_pose.csv");
  constexpr double near = 0.003;  // metres; docs/calibration.md: the robot moves in most frames
  EXPECT_LT((found.translation() - truth.translation()).norm(), near);
}

}  // namespace
}  // namespace penumbra::test
