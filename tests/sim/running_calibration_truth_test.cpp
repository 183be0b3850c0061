// SPDX-License-Identifier: Apache-2.0
// A calibration while the cell runs, over MuJoCo's cameras, whose pose is known, under a D415's
// noise.
#include "simulated.hpp"

#include <penumbra/session/session.hpp>

namespace penumbra::test {
namespace {

// docs/calibration.md: ten poses of the shipped arm end within these of the truth. The arm moves
// here, by up to 10 mm between an image and the next, but its joints are of the image's stamp.
constexpr double near_truth = 0.004, near_turn = 0.004;  // metres, rad

/// A session of the scene "random" whose TF has the camera 'off' from where it is.
class Cell {
 public:
  explicit Cell(const Isometry3d& off) : off_(off) {
    calibration.follow(simulation_.robot(), camera_, {}, Isometry3d::Identity());
  }

  /// Judges frames until `done`, at most so many.
  template <typename Done>
  bool run_until(const Done& done, std::size_t most) {
    sim::SimFrame next;
    for (std::size_t i = 0; i < most && simulation_.next(next); ++i) {
      judge(next);
      if (done()) return true;
    }
    return false;
  }
  /// Judges so many frames, then waits for the result.
  CalibrationProgress run(std::size_t count) {
    run_until([] { return false; }, count);
    calibration.finish();
    return calibration.progress();
  }
  void move_camera(const Isometry3d& motion) { off_ = off_ * motion.inverse(); }

  void expect_truth(const CalibrationProgress& of) const {
    ASSERT_TRUE(of.found) << of.message;
    EXPECT_TRUE(of.is_ready()) << of.message;
    const Isometry3d error = simulation_.T_base_camera().inverse() * of.found->T_parent_camera;
    EXPECT_LT(error.translation().norm(), near_truth) << of.message;
    EXPECT_LT(std::abs(AngleAxisd(error.linear()).angle()), near_turn) << of.message;
    EXPECT_LT(error.translation().norm(), 1.5 * of.found->position_error());
  }

  RunningCalibration calibration;

 private:
  void judge(const sim::SimFrame& next) {
    Frame frame{
        .index = judged_++,
        .stamp = next.stamp,
        .depth = next.depth.view(),
        .pose = {.positions = next.joints, .T_parent_camera = simulation_.T_base_camera() * off_}};
    session_.process(frame);
    calibration.take(frame, session_.drift());
  }

  Isometry3d off_;
  sim::Simulation simulation_{"random", without_color(3, true)};
  Camera camera_ = simulation_.camera();
  Session session_{simulation_.robot(), camera_, {}};
  std::size_t judged_ = 0;
};

Isometry3d moved(double x, double y, double z, double degrees) {
  Isometry3d pose(Eigen::Translation3d(x, y, z));
  pose.linear() = AngleAxisd(degrees * degree, Vector3d(1, 2, -1).normalized()).matrix();
  return pose;
}

using RunningCalibrationTruth = SimulationTest;

TEST_F(RunningCalibrationTruth, FindsThePoseFromTf) {
  Cell cell(moved(0.03, -0.04, 0.03, 3));
  cell.calibration.begin(false);
  const CalibrationProgress of = cell.run(150);
  cell.expect_truth(of);
  EXPECT_TRUE(holds(of.message, "beyond that")) << of.message;
  EXPECT_EQ(of.poses, of.found->frames.size());
}

TEST_F(RunningCalibrationTruth, FindsThePoseFromNothing) {
  if (!is_full_run()) GTEST_SKIP() << "skipped: a search takes a while: PENUMBRA_FULL=1";
  Cell cell(moved(0.5, 0.2, 0.1, 60));
  cell.calibration.begin(true);
  cell.expect_truth(cell.run(150));
}

TEST_F(RunningCalibrationTruth, HasTheNewPoseReadyAfterTheCameraMoved) {
  Cell cell(Isometry3d::Identity());
  constexpr std::size_t before = 300, until_seen = 1500, after = 150;
  EXPECT_FALSE(cell.run_until([&] { return cell.calibration.progress().is_running; }, before));
  EXPECT_EQ(cell.calibration.progress().message, "");
  cell.move_camera(moved(0.02, -0.018, 0.013, 0.5));  // by 30 mm
  ASSERT_TRUE(cell.run_until([&] { return cell.calibration.progress().is_running; }, until_seen));
  const CalibrationProgress of = cell.run(after);
  EXPECT_TRUE(of.has_moved);
  EXPECT_TRUE(holds(of.message, "the camera has moved")) << of.message;
  cell.expect_truth(of);
}

}  // namespace
}  // namespace penumbra::test
