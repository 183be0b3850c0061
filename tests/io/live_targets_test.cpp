// SPDX-License-Identifier: Apache-2.0
// Targets of an inbox: the image that they come with, and the cameras that they are for.
#include "live_scene.hpp"

#include <tuple>

namespace penumbra::test {
namespace {

/// A planned motion of the board by a quarter of a turn in a second.
io::JointTrajectoryMessage quarter_turn() {
  io::JointTrajectoryMessage motion{.joint_names = {"spin"}};
  motion.points.push_back({.positions = {spin_at(start)}});
  motion.points.push_back(
      {.positions = {spin_at(start) + 0.5 * std::numbers::pi}, .time_from_start = {.sec = 1}});
  return motion;
}

/// Publishes messages of motions, then a ball that is above the board, and behind it once the board
/// is a quarter turned.
class LivePlans : public testing::Test {
 protected:
  LivePlans() : bench_(options()) { bench_.tell_all(); }
  static io::LiveOptions options() {
    io::LiveOptions options = LiveBench::one_camera({"/ball"});
    options.motion_topics = {"/joint_trajectory"};
    return options;
  }
  io::TargetMessage forecast() {
    bench_.tell_depth(start - seconds);
    bench_.publish("/ball", live_target(start, {0.0, 0.3, 2.0}));
    bench_.tell_joints(start);
    bench_.tell_depth(start);
    EXPECT_EQ(bench_.work(), 1U);
    return bench_.results.last<io::TargetsMessage>(io::Result::targets).targets.at(0);
  }

  LiveBench bench_;
};

TEST_F(LivePlans, AreForecast) {
  bench_.publish("/joint_trajectory", encoded(quarter_turn()));
  // The ray to the ball's middle meets the board's near face 0.95 m away, 0.1425 m from its axis;
  // the board's edge is 0.1 m from it.
  const double begin = std::acos(0.1 / 0.1425) / (0.5 * std::numbers::pi);
  constexpr double radius = 0.06;  // seconds in which the edge passes half of the ball
  const io::TargetMessage ball = forecast();
  EXPECT_NEAR(ball.forecast_seconds, 1.0, 1e-9);
  EXPECT_GT(ball.hidden_in, begin);
  EXPECT_LT(ball.hidden_in, begin + radius);
  EXPECT_EQ(ball.hidden_for, std::numeric_limits<double>::infinity());
  EXPECT_EQ(ball.hidden_by, "board");
  EXPECT_EQ(ball.forecast_reason, "");
}

TEST_F(LivePlans, WithoutOneNothingIsForecast) {
  bench_.publish("/joint_trajectory", encoded(quarter_turn()));
  bench_.publish("/joint_trajectory", encoded(io::JointTrajectoryMessage()));  // stops the motion
  const io::TargetMessage ball = forecast();
  EXPECT_TRUE(ball.forecast_seconds == 0.0 && std::isnan(ball.hidden_in));
  EXPECT_EQ(bench_.inbox.faults().all().size(), 0U);
}

TEST_F(LivePlans, OfAnotherRobotAreFaults) {
  io::JointTrajectoryMessage other = quarter_turn();
  other.joint_names = {"elbow"};
  bench_.publish("/joint_trajectory", encoded(other));
  EXPECT_TRUE(std::isnan(forecast().hidden_in));
  EXPECT_EQ(bench_.inbox.faults().all().size(), 1U);
}

TEST(LiveTargets, GoToTheCamerasThatKnowTheirFrame) {
  io::LiveOptions options;
  for (const char* name : {"/left", "/right"})
    options.cameras.push_back(
        {.name = name, .depth_topic = name, .info_topic = name + std::string("/camera_info")});
  options.target_topics = {"/part"};
  LiveBench bench(options);
  bench.tell_robot();
  bench.tell_mount();
  bench.tell_transform("base", "aside");
  const auto show = [&](const std::string& camera, const std::string& frame, std::int64_t stamp) {
    io::CameraInfoMessage info = live_info(0);
    info.header.frame_id = frame;
    bench.publish(camera + "/camera_info", encoded(info));
    bench.publish(camera, live_depth(stamp, frame));
  };
  const auto tell_part = [&](const std::string& frame, std::int64_t stamp) {
    bench.publish("/part", live_target(stamp, {0.0, 0.0, 2.0}, frame));
  };
  const auto received = [&](std::size_t camera) {
    EXPECT_TRUE(bench.inbox.next(camera, bench.now, false, bench.job));
    const std::size_t targets = bench.job.targets.size();
    bench.inbox.done(camera, {}, bench.now, bench.now);
    return targets;
  };
  show("/left", "optical", start - seconds);
  tell_part("aside", start - seconds);  // of the right camera, which is not known yet
  show("/right", "aside", start - seconds);
  std::int64_t stamp = start;
  const auto judge = [&] {
    stamp += 100 * milliseconds;
    bench.tell_joints_around(stamp);
    show("/left", "optical", stamp);
    show("/right", "aside", stamp);
    const std::size_t left = received(0);
    return std::pair(left, received(1));
  };
  EXPECT_EQ(judge(), std::pair(0UL, 0UL)) << "the left camera did not take it";
  for (const auto& [frame, left, right] :
       {std::tuple("optical", 1UL, 0UL), {"/aside", 0, 1}, {"board", 1, 1}, {"none", 1, 1}}) {
    tell_part(frame, stamp + 100 * milliseconds);
    EXPECT_EQ(judge(), std::pair(left, right)) << frame;
  }
}

}  // namespace
}  // namespace penumbra::test
