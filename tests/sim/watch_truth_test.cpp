// SPDX-License-Identifier: Apache-2.0
// The watch over MuJoCo's cameras, whose pose is known, under a D415's noise.
#include "simulated.hpp"

#include <penumbra/calibration/calibration.hpp>

namespace penumbra::test {
namespace {

using Watch = SimulationTest;

class Watched {
 public:
  /// Judges frames of the scene "random" with a camera that has moved by `motion` since it was
  /// calibrated.
  void watch(std::size_t count, const Eigen::Isometry3d& motion) {
    sim::SimFrame frame;
    for (std::size_t i = 0; i < count && simulation_.next(frame); ++i) judge(frame, motion);
  }

  [[nodiscard]] const Drift& drift() const { return watch_.drift(); }

  /// Judges one frame again and again.
  void stare(std::size_t count) {
    sim::SimFrame frame;
    ASSERT_TRUE(simulation_.next(frame));
    for (std::size_t i = 0; i < count; ++i) judge(frame, Eigen::Isometry3d::Identity());
  }

 private:
  void judge(const sim::SimFrame& frame, const Eigen::Isometry3d& motion) {
    watch_.add(pipeline_.process(
        {.depth = frame.depth.view(),
         .pose = {.positions = frame.joints,
                  .T_parent_camera = simulation_.T_base_camera() * motion.inverse()}}));
  }

  sim::Simulation simulation_{"random", without_color(3, true)};
  Pipeline pipeline_{simulation_.robot(), simulation_.camera(), {}};
  CalibrationWatch watch_{simulation_.camera()};
};

TEST_F(Watch, TellsABumpAndHowFar) {
  Watched camera;
  constexpr std::size_t before = 120, after = 100;
  camera.watch(before, Eigen::Isometry3d::Identity());
  const Drift still = camera.drift();
  EXPECT_TRUE(still.is_known);
  EXPECT_EQ(still.message(), "");
  EXPECT_LT(still.position(), 1.5 * still.position_error());

  Eigen::Isometry3d bump = Eigen::Isometry3d::Identity();
  bump.translation() = Eigen::Vector3d(0.004, -0.002, 0.003);
  bump.linear() = Eigen::AngleAxisd(0.3 * degree, Eigen::Vector3d::UnitY()).matrix();
  camera.watch(after, bump);
  const Drift drift = camera.drift();
  EXPECT_TRUE(drift.has_moved);
  ASSERT_TRUE(drift.bumped_at);
  constexpr double frames_off = 30.0;  // as many as a view may take
  EXPECT_NEAR(static_cast<double>(*drift.bumped_at), before, frames_off);
  const Eigen::Isometry3d error = bump.inverse() * drift.T_calibrated_camera;
  EXPECT_LT(error.translation().norm(), 1.5 * drift.position_error());
  EXPECT_LT(std::abs(Eigen::AngleAxisd(error.linear()).angle()), 1.5 * drift.rotation_error());
  EXPECT_NE(drift.message().find("bumped at frame"), std::string::npos) << drift.message();
}

/// Images with the joints of two frames later; the camera stays.
TEST_F(Watch, NamesClocksThatDifferAndNotTheCamera) {
  constexpr std::size_t frames = 300, late = 2;
  constexpr double frame_time = 1.0 / 30.0, error = 0.006;  // seconds
  sim::Simulation simulation("handover", without_color(3, true));
  Pipeline pipeline(simulation.robot(), simulation.camera(), {});
  CalibrationWatch watch(simulation.camera());
  std::deque<sim::SimFrame> waiting;
  sim::SimFrame frame;
  for (std::size_t i = 0; i < frames && simulation.next(frame); ++i) {
    waiting.push_back(frame);
    if (waiting.size() <= late) continue;
    watch.add(pipeline.process(
        {.stamp = waiting.front().stamp,
         .depth = std::as_const(waiting.front().depth).view(),
         .pose = {.positions = frame.joints, .T_parent_camera = simulation.T_base_camera()}}));
    ASSERT_FALSE(watch.drift().has_moved || watch.drift().bumped_at) << i;
    waiting.pop_front();
  }
  const Drift& drift = watch.drift();
  EXPECT_TRUE(drift.clocks_differ) << drift.time_offset.value;
  EXPECT_NEAR(drift.time_offset.value, -(late * frame_time), error);
  EXPECT_NE(drift.message().find("time_offset"), std::string::npos);
  EXPECT_EQ(drift.message().find("calibrate"), std::string::npos);
}

/// Its views are the same again and again, so that their scatter tells little of their errors: by
/// that alone the watch found a bump in repeat 381.
TEST_F(Watch, ARepeatedMotionIsNoBump) {
  if (!is_full_run()) GTEST_SKIP() << "skipped: half a minute: PENUMBRA_FULL=1";
  constexpr std::size_t repeats = 500, frames = 150;
  constexpr std::int64_t period = 33'333'333, before_again = 8'000'000;  // nanoseconds
  sim::Simulation simulation("conveyor", without_color(3, true));
  Pipeline pipeline(simulation.robot(), simulation.camera(), {});
  CalibrationWatch watch(simulation.camera());
  std::vector<sim::SimFrame> motion(frames);
  for (sim::SimFrame& frame : motion) ASSERT_TRUE(simulation.next(frame));
  std::int64_t stamp = 0;
  for (std::size_t i = 0; i < repeats; ++i, stamp += before_again)
    for (const sim::SimFrame& frame : motion) {
      watch.add(pipeline.process(
          {.stamp = stamp += period,
           .depth = frame.depth.view(),
           .pose = {.positions = frame.joints, .T_parent_camera = simulation.T_base_camera()}}));
      ASSERT_FALSE(watch.drift().has_moved || watch.drift().bumped_at) << "in repeat " << i;
    }
  EXPECT_TRUE(watch.drift().is_known);
}

TEST_F(Watch, TellsARobotThatIsNotThere) {
  Watched camera;
  Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
  far.translation().x() = 0.5;
  camera.watch(300, far);
  EXPECT_NE(camera.drift().message().find("sees past"), std::string::npos)
      << camera.drift().seen_through;
}

TEST_F(Watch, KnowsNothingOfARobotThatStands) {
  Watched camera;
  camera.stare(400);
  EXPECT_FALSE(camera.drift().is_known);
}

}  // namespace
}  // namespace penumbra::test
