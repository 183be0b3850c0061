// SPDX-License-Identifier: Apache-2.0
// Targets of an inbox: the image that they come with, and the cameras that they are for.
#include "live_scene.hpp"

#include <utility>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

TEST(LiveTargets, ComeWithTheNextImage) {
  io::LiveOptions options = LiveBench::one_camera();
  options.target_topics = {"/wrist"};
  LiveBench bench(options);
  for (std::size_t i = 0; i < bench.inbox.topics().size(); ++i)
    if (bench.inbox.topics()[i].role == io::TopicRole::targets)
      bench.inbox.set_type(i, "geometry_msgs/msg/PoseStamped");
  bench.tell_all();
  bench.tell_depth(start - seconds);  // the camera's frame is known by its first image
  io::PoseStampedMessage pose{.header = {start, "optical"}};
  pose.pose.translation() = Eigen::Vector3d(1.2, 0.0, 3.0);
  bench.publish("/wrist", encoded(pose));
  bench.tell_joints(start);
  bench.tell_depth(start);
  EXPECT_EQ(bench.work(), 1U);
  const auto targets = bench.results.last<io::TargetsMessage>(io::Result::targets).targets;
  ASSERT_EQ(targets.size(), 1U);
  EXPECT_EQ(targets[0].name, "/wrist");
  EXPECT_EQ(targets[0].verdict, io::TargetMessage::visible);
}

/// A planned motion of the board by a quarter of a turn in a second.
io::JointTrajectoryMessage quarter_turn() {
  io::JointTrajectoryMessage motion{.joint_names = {"spin"}};
  motion.points.push_back({.positions = {spin_at(start)}});
  motion.points.push_back(
      {.positions = {spin_at(start) + 0.5 * std::numbers::pi}, .time_from_start = {.sec = 1}});
  return motion;
}

/// What is said at `start` of a ball above the board, behind it, once the board is a quarter
/// turned.
io::TargetMessage forecast_of_a_ball(LiveBench& bench) {
  for (std::size_t i = 0; i < bench.inbox.topics().size(); ++i)
    if (bench.inbox.topics()[i].role == io::TopicRole::targets)
      bench.inbox.set_type(i, "geometry_msgs/msg/PoseStamped");
  bench.tell_depth(start - seconds);
  io::PoseStampedMessage ball{.header = {start, "optical"}};
  ball.pose.translation() = Eigen::Vector3d(0.0, 0.3, 2.0);
  bench.publish("/ball", encoded(ball));
  bench.tell_joints(start);
  bench.tell_depth(start);
  EXPECT_EQ(bench.work(), 1U);
  return bench.results.last<io::TargetsMessage>(io::Result::targets).targets.at(0);
}

io::LiveOptions with_a_ball() {
  io::LiveOptions options = LiveBench::one_camera();
  options.target_topics = {"/ball"};
  options.motion_topics = {"/joint_trajectory"};
  return options;
}

TEST(LivePlans, AreForecast) {
  // The ray to the ball's middle meets the board's near face 0.95 m away, 0.1425 m from its axis;
  // the board's edge is 0.1 m from it.
  const double begin = std::acos(0.1 / 0.1425) / (0.5 * std::numbers::pi);
  constexpr double radius = 0.06;  // seconds in which the edge passes half of the ball
  io::DisplayTrajectoryMessage planned{.model_id = "tiny", .parts = {{.joints = quarter_turn()}}};
  for (const bool is_planned : {true, false}) {
    LiveBench bench(with_a_ball());
    bench.tell_all();
    if (is_planned)
      bench.publish("/display_planned_path", encoded(planned));
    else
      bench.publish("/joint_trajectory", encoded(quarter_turn()));
    const io::TargetMessage ball = forecast_of_a_ball(bench);
    EXPECT_NEAR(ball.forecast_seconds, 1.0, 1e-9);
    EXPECT_GT(ball.hidden_in, begin);
    EXPECT_LT(ball.hidden_in, begin + radius);
    EXPECT_EQ(ball.hidden_for, std::numeric_limits<double>::infinity());
    EXPECT_EQ(ball.hidden_by, "board");
    EXPECT_EQ(ball.forecast_reason, "");
  }
}

TEST(LivePlans, WithoutOneNothingIsForecast) {
  LiveBench bench(with_a_ball());
  bench.tell_all();
  bench.publish("/joint_trajectory", encoded(quarter_turn()));
  bench.publish("/joint_trajectory", encoded(io::JointTrajectoryMessage()));  // stops the motion
  const io::TargetMessage ball = forecast_of_a_ball(bench);
  EXPECT_TRUE(ball.forecast_seconds == 0.0 && std::isnan(ball.hidden_in));
  EXPECT_EQ(bench.inbox.faults().all().size(), 0U);
}

TEST(LivePlans, OfAnotherRobotAreFaults) {
  LiveBench bench(with_a_ball());
  bench.tell_all();
  io::JointTrajectoryMessage other = quarter_turn();
  other.joint_names = {"elbow"};
  bench.publish("/joint_trajectory", encoded(other));
  const io::TargetMessage ball = forecast_of_a_ball(bench);
  EXPECT_TRUE(std::isnan(ball.hidden_in));
  EXPECT_EQ(bench.inbox.faults().all().size(), 1U);
}

TEST(LiveTargets, GoToTheCamerasThatKnowTheirFrame) {
  io::LiveOptions options;
  for (const char* name : {"/left", "/right"})
    options.cameras.push_back(
        {.name = name, .depth_topic = name, .info_topic = name + std::string("/camera_info")});
  options.target_topics = {"/part"};
  LiveBench bench(options);
  for (std::size_t i = 0; i < bench.inbox.topics().size(); ++i)
    if (bench.inbox.topics()[i].role == io::TopicRole::targets)
      bench.inbox.set_type(i, "geometry_msgs/msg/PoseStamped");
  bench.tell_robot();
  bench.publish("/tf_static",
                encoded(io::TfMessage{{{{0, "base"}, "optical"}, {{0, "base"}, "aside"}}}));
  const auto show = [&](const std::string& camera, const std::string& frame, std::int64_t stamp) {
    io::CameraInfoMessage info = live_info(0);
    info.header.frame_id = frame;
    bench.publish(camera + "/camera_info", encoded(info));
    bench.publish(camera, live_depth(stamp, frame));
  };
  const auto tell_part = [&](const std::string& frame, std::int64_t stamp) {
    io::PoseStampedMessage part{.header = {stamp, frame}};
    part.pose.translation() = Eigen::Vector3d(0.0, 0.0, 2.0);
    bench.publish("/part", encoded(part));
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
  struct Case {
    const char* frame;
    std::size_t left, right;
  };
  std::int64_t stamp = start;
  const auto judge = [&] {
    stamp += 100 * milliseconds;
    for (const int around : {-10, 10}) bench.tell_joints(stamp + around * milliseconds);
    show("/left", "optical", stamp);
    show("/right", "aside", stamp);
    const std::size_t left = received(0);
    return std::pair(left, received(1));
  };
  EXPECT_EQ(judge(), std::pair(0UL, 0UL)) << "the left camera did not take it";
  for (const auto& [frame, left, right] :
       {Case{"optical", 1, 0}, {"/aside", 0, 1}, {"board", 1, 1}, {"none", 1, 1}}) {
    tell_part(frame, stamp + 100 * milliseconds);
    EXPECT_EQ(judge(), std::pair(left, right)) << frame;
  }
}

}  // namespace
}  // namespace penumbra::test
