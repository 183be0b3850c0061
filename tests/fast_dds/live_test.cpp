// SPDX-License-Identifier: Apache-2.0
// `penumbra live` on ROS 2's graph, where `penumbra play` plays the tiny recording.
#include "../apps/tiny_clouds.hpp"
#include "../apps/tiny_recording.hpp"
#include "../support/opengl.hpp"
#include "../support/run_length.hpp"
#include "live_graph.hpp"

#include <algorithm>
#include <cmath>

#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

class LiveTest : public LiveGraph {
 protected:
  LiveTest() {
    write_tiny_recording(folder_.path());
    bag_ = tiny_bag(folder_.path());
  }

  TinyBag bag_;
};

TEST_F(LiveTest, CloudsAndScansComeWithoutTheRobot) {
  add_clouds(bag_);
  const auto points = hear("/penumbra/points", "sensor_msgs/msg/PointCloud2");
  const auto labelled = hear("/penumbra/points/labelled", "sensor_msgs/msg/PointCloud2");
  const auto scans = hear("/penumbra/scan", "sensor_msgs/msg/LaserScan");
  const auto livox = hear("/penumbra/livox/lidar", "livox_ros_driver2/msg/CustomMsg");
  const auto program = live({"--robot", path("tiny.urdf"), "--cloud", "/points", "--cloud",
                             "/scan removed_ranges=inf sensor=hokuyo", "--cloud", "/livox/lidar",
                             "--summary", path("summary.json")});
  const auto player = play_in_loop(bag_);
  const auto thrice = [](const auto& is_right) {
    return [is_right, count = 0](const auto& message) mutable {
      count += is_right(message) ? 1 : 0;
      return count > 2;
    };
  };
  EXPECT_TRUE(hears<io::PointCloud2Message>(*points, thrice([](const auto& m) {
    return numbers_of(m) == std::vector{1, 2};
  })));
  EXPECT_TRUE(hears<io::PointCloud2Message>(*labelled, thrice([](const auto& m) {
    return numbers_of(m).size() == 4 && m.fields.back().name == "link";
  })));
  EXPECT_TRUE(hears<io::LaserScanMessage>(*scans, thrice([](const auto& m) {
    return m.ranges.at(0) == 3.0F && std::isinf(m.ranges.at(1)) && m.ranges.at(2) == 3.0F;
  })));
  EXPECT_TRUE(hears<io::LivoxMessage>(*livox, thrice([](const auto& m) {
    return m.points.size() == 1 && m.points[0].y == 2.0F;
  }))) << read_file(path("live.log"));
  EXPECT_EQ(program->end(), 0);
  const Json summary = read_json(path("summary.json"));
  ASSERT_EQ(summary["clouds"].size(), 3U);
  EXPECT_EQ(summary["clouds"][0]["topic"], "/points");
  EXPECT_GT(summary["clouds"][0]["points"]["occluded"], 2);
  EXPECT_GT(summary["clouds"][1]["judged"], 2);
  EXPECT_TRUE(summary["cameras"].empty());
}

/// The board moves on the motion that MoveIt shows, towards a knob that it hides until its near
/// face has passed.
TEST_F(LiveTest, APlanIsForecast) {
  io::DisplayTrajectoryMessage plan{.model_id = "tiny", .parts = {{}}};
  plan.parts[0].joints = {
      .joint_names = {"slide"},
      .points = {{.positions = {0.0}},
                 {.positions = {tiny_speed * 6}, .time_from_start = {.sec = 6}}}};
  bag_.add("/display_planned_path", tiny_stamp(0) - 1'000'000, plan);
  for (int frame = 0; frame < 3; ++frame)
    bag_.add("/knob", tiny_stamp(frame),
             io::PoseStampedMessage{{tiny_stamp(frame), "optical"},
                                    Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.5))});
  const auto heard = hear("/penumbra/targets", "penumbra_msgs/msg/Targets");
  const auto program = live({"--depth-topic", "/camera/depth/image_rect_raw", "--robot",
                             path("tiny.urdf"), "--target-topic", "/knob"});
  const auto player = play_in_loop(bag_);
  EXPECT_TRUE(hears<io::TargetsMessage>(*heard, [](const auto& message) {
    if (message.targets.empty() || message.targets[0].forecast_seconds <= 0) return false;
    EXPECT_EQ(message.targets[0].hidden_in, 0.0);
    EXPECT_EQ(message.targets[0].hidden_by, "board");
    EXPECT_NEAR(message.targets[0].forecast_seconds, 2.0, 1e-9);
    return true;
  })) << read_file(path("live.log"));
  EXPECT_EQ(program->end(), 0);
}

TEST_F(LiveTest, RemapsItsDiagnostics) {
  const auto heard = hear("/cell/health", "diagnostic_msgs/msg/DiagnosticArray");
  const auto program = live({"--depth-topic", "/depth", "--remap", "/diagnostics:=/cell/health"});
  EXPECT_TRUE(hears<io::DiagnosticArrayMessage>(
      *heard, [](const auto& message) { return !message.status.empty(); }));
  const auto topics = graph_->graph();
  EXPECT_TRUE(std::none_of(topics.begin(), topics.end(),
                           [](const auto& topic) { return topic.name == "/diagnostics"; }));
  EXPECT_EQ(program->end(), 0);
}

#ifdef PENUMBRA_FAILING_DEVICE
TEST_F(LiveTest, ADeviceThatFailsLeavesTheSummary) {
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";  // what fails wants to be the first library
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  write_file(path("live.json"), "former");
  const auto player = play_in_loop(bag_);
  const Outcome outcome =
      penumbra(on_domain("live", {"--depth-topic", "/camera/depth/image_rect_raw", "--robot",
                                  path("tiny.urdf"), "--duration", "120", "--summary",
                                  path("live.json"), "--renderer", "gl"}),
               {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE, "PENUMBRA_TEST_SPARED=6"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  expect_has(outcome.err, {"OpenGL: the graphics device was reset"});
  expect_lacks(outcome.err, {"left as it was"});
  const Json json = read_json(path("live.json"));
  const std::string fault = json["fault"];
  EXPECT_TRUE(fault.starts_with("OpenGL: the graphics device was reset")) << fault;
  const Json& camera = json["cameras"][0];
  EXPECT_GT(camera["judged"], 0);
  EXPECT_EQ(camera["in_work"], 1) << "the one that failed";
  EXPECT_EQ(camera["renderer"]["backend"], "gl");
  EXPECT_TRUE(camera["renderer"]["device"].is_string());
}
#endif

}  // namespace
}  // namespace penumbra::test
