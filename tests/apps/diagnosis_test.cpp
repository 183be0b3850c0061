// SPDX-License-Identifier: Apache-2.0
// What run, tune and calibrate say of a real recording whose setup is wrong.
#include "../support/data.hpp"
#include "fixtures.hpp"

#include <functional>

#include <Eigen/Geometry>

#include <io/files/pose_file.hpp>

namespace penumbra::test {
namespace {

class DiagnosisTest : public testing::Test {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_DATA();
    fs::copy(data_folder() / "xarm7_realsense", path("recording"), fs::copy_options::recursive);
    const fs::path robots = fs::absolute(data_folder() / "robots/xarm7");
    edit_file(path("recording/recording.yaml"), "../robots/xarm7/xarm7.urdf",
              robots / "xarm7.urdf");
    edit_file(path("recording/recording.yaml"), "../robots/xarm7/xarm_description",
              robots / "xarm_description");
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// Replaces the camera's pose.
  void spoil(const std::function<Eigen::Isometry3d(Eigen::Isometry3d)>& change) {
    io::write_pose_csv(path("recording/camera_pose.csv"),
                       change(io::read_pose_csv(path("recording/camera_pose.csv"))));
  }

  Outcome run(Words options = {}) {
    Words words{"run", path("recording"), "-o", path("out")};
    words.insert(words.end(), options.begin(), options.end());
    return penumbra(words);
  }
  [[nodiscard]] Json diagnosis() const {
    return Json::parse(read_file(path("out/report.json")))["summary"]["diagnosis"];
  }

  TemporaryFolder folder_;
};

TEST_F(DiagnosisTest, AnInvertedPoseEndsWithStatus2) {
  spoil([](const Eigen::Isometry3d& T) { return T.inverse(); });
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(diagnosis()["cause"], "camera_inverted");
  EXPECT_EQ(outcome.out.find(" 0 bad"), std::string::npos) << outcome.out;
  EXPECT_EQ(run({"--force"}).status, 0);
}

TEST_F(DiagnosisTest, TuneRefusesAWrongPose) {
  spoil([](Eigen::Isometry3d T) {
    T.translation().x() += 0.05;
    return T;
  });
  EXPECT_EQ(run().status, 0);
  EXPECT_EQ(diagnosis()["cause"], "camera_pose");
  const Words tune{"tune", path("recording"), "-o", path("tuned")};
  const Outcome outcome = penumbra(tune);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("penumbra calibrate"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(path("tuned")));
}

TEST_F(DiagnosisTest, DepthScaleMendsDepthOfAnotherUnit) {
  EXPECT_EQ(run().status, 0);
  EXPECT_TRUE(diagnosis().is_null()) << diagnosis();
  edit_file(path("recording/recording.yaml"), "  pose:", "  depth_scale: 0.01\n  pose:");
  EXPECT_EQ(run().status, 2);
  EXPECT_EQ(diagnosis()["cause"], "depth_unit");
  edit_file(path("recording/recording.yaml"), "0.01\n", "0.001\n");
  EXPECT_EQ(run().status, 0);
  EXPECT_TRUE(diagnosis().is_null()) << diagnosis();
  edit_file(path("recording/recording.yaml"), "0.001\n", "0\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("depth_scale"), std::string::npos) << outcome.err;
}

TEST_F(DiagnosisTest, CalibrateNamesWhatIsNotThePose) {
  edit_file(path("recording/recording.yaml"), "  pose:", "  depth_scale: 0.01\n  pose:");
  const Outcome outcome = penumbra({"calibrate", path("recording")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("depth_scale"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace penumbra::test
