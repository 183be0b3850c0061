// SPDX-License-Identifier: Apache-2.0
// A planned motion on ROS 2's graph, and what `penumbra live` says that it will hide.
#include "../apps/program.hpp"
#include "../apps/tiny_bag.hpp"
#include "../apps/tiny_recording.hpp"
#include "listening.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"

#include <cmath>
#include <cstdlib>
#include <future>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include <io/ros/message_decoder.hpp>
#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

/// A bag whose board moves on the motion that MoveIt shows, towards a knob that it hides until its
/// near face has passed.
void write_planned_bag(const std::filesystem::path& folder) {
  TinyBag bag = tiny_bag(folder);
  io::DisplayTrajectoryMessage plan{.model_id = "tiny", .parts = {{}}};
  plan.parts[0].joints.joint_names = {"slide"};
  for (const int second : {0, 6})
    plan.parts[0].joints.points.push_back(
        {.positions = {tiny_speed * second}, .time_from_start = {.sec = second}});
  bag.add("/display_planned_path", tiny_stamp(0) - 1'000'000, plan);
  for (int frame = 0; frame < 3; ++frame) {
    io::PoseStampedMessage knob{.header = {tiny_stamp(frame), "optical"}};
    knob.pose.translation() = Eigen::Vector3d(0.0, 0.0, 1.5);
    bag.add("/knob", tiny_stamp(frame), knob);
  }
  bag.write_mcap(folder / "bag.mcap");
}

TEST(LivePlan, IsForecastOnTheGraph) {
  const LoneDomain domain;
  const TemporaryFolder folder;
  const std::string id = std::to_string(domain.id());
  write_tiny_recording(folder.path());
  write_planned_bag(folder.path());
  const auto graph = io::join_graph({.domain = domain.id()});
  const auto heard = graph->subscribe("/penumbra/targets", "penumbra_msgs/msg/Targets",
                                      {.reliable = true, .depth = 100});
  LiveProgram live({"--domain", id, "--depth-topic", "/camera/depth/image_rect_raw", "--robot",
                    folder.path() / "tiny.urdf", "--target-topic", "/knob"},
                   folder.path() / "live.log");
  const std::string play = "timeout --preserve-status -s INT 10 '" PENUMBRA_PROGRAM
                           "' play --loop --restamp --domain " +
                           id + " '" + (folder.path() / "bag.mcap").string() + "' >/dev/null";
  const auto player = std::async(std::launch::async, [&] { return std::system(play.c_str()); });
  std::optional<io::TargetMessage> forecast;
  io::Sample sample;
  const io::Decoder<io::TargetsMessage> decoder;
  EXPECT_TRUE(eventually(*graph, [&] {
    io::TargetsMessage message;
    while (heard->take(sample))
      if (!decoder.decode(sample.data, message) && !message.targets.empty() &&
          message.targets[0].forecast_seconds > 0)
        forecast = message.targets[0];
    return forecast.has_value();
  })) << read_file(folder.path() / "live.log");
  if (forecast) {
    std::cout << "'" << forecast->name << "' is hidden in " << forecast->hidden_in << " s by '"
              << forecast->hidden_by << "', for " << forecast->hidden_for << " s of the next "
              << forecast->forecast_seconds << " s\n";
    EXPECT_EQ(forecast->hidden_in, 0.0);
    EXPECT_EQ(forecast->hidden_by, "board");
    EXPECT_NEAR(forecast->forecast_seconds, 2.0, 1e-9);
  }
  EXPECT_EQ(live.end(), 0);
}

}  // namespace
}  // namespace penumbra::test
