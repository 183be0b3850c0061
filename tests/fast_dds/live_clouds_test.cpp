// SPDX-License-Identifier: Apache-2.0
// Clouds and laser scans on ROS 2's graph, and what `penumbra live` publishes in their place.
#include "../apps/program.hpp"
#include "../apps/tiny_clouds.hpp"
#include "../apps/tiny_recording.hpp"
#include "listening.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"

#include <cstdlib>
#include <future>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

TEST(LiveCloudTopics, ComeWithoutTheRobot) {
  const LoneDomain domain;
  const TemporaryFolder folder;
  const std::string id = std::to_string(domain.id());
  write_tiny_recording(folder.path());
  TinyBag bag = tiny_bag(folder.path());
  add_clouds(bag);
  bag.write_mcap(folder.path() / "bag.mcap");
  const auto graph = io::join_graph({.domain = domain.id()});
  const auto hear = [&](const std::string& topic, const std::string& type) {
    return graph->subscribe(topic, type, {.reliable = true, .depth = 100});
  };
  const auto points = hear("/penumbra/points", "sensor_msgs/msg/PointCloud2");
  const auto labelled = hear("/penumbra/points/labelled", "sensor_msgs/msg/PointCloud2");
  const auto scans = hear("/penumbra/scan", "sensor_msgs/msg/LaserScan");
  const auto livox = hear("/penumbra/livox/lidar", "livox_ros_driver2/msg/CustomMsg");
  LiveProgram live({"--domain", id, "--robot", folder.path() / "tiny.urdf", "--cloud", "/points",
                    "--cloud", "/scan removed_ranges=inf sensor=hokuyo", "--cloud", "/livox/lidar",
                    "--summary", folder.path() / "summary.json"},
                   folder.path() / "live.log");
  const std::string play = "timeout --preserve-status -s INT 10 '" PENUMBRA_PROGRAM
                           "' play --loop --restamp --domain " +
                           id + " '" + (folder.path() / "bag.mcap").string() + "' >/dev/null";
  const auto player = std::async(std::launch::async, [&] { return std::system(play.c_str()); });
  std::size_t clean = 0, with_labels = 0, without_board = 0, of_livox = 0;
  io::Sample sample;
  const auto count = [&sample]<typename M, typename F>(io::Subscription& heard, M message,
                                                       std::size_t& number, const F& is_right) {
    while (heard.take(sample)) {
      ASSERT_FALSE(io::Decoder<M>().decode(sample.data, message));
      number += is_right(message) ? 1 : 0;
    }
  };
  EXPECT_TRUE(eventually(
      *graph,
      [&] {
        count(*points, io::PointCloud2Message(), clean, [](const auto& m) {
          return numbers_of(m) == std::vector{1, 2};
        });
        count(*labelled, io::PointCloud2Message(), with_labels, [](const auto& m) {
          return numbers_of(m).size() == 4 && m.fields.back().name == "link";
        });
        count(*scans, io::LaserScanMessage(), without_board, [](const auto& m) {
          return m.ranges.at(0) == 3.0F && std::isinf(m.ranges.at(1)) && m.ranges.at(2) == 3.0F;
        });
        count(*livox, io::LivoxMessage(), of_livox,
              [](const auto& m) { return m.points.size() == 1 && m.points[0].y == 2.0F; });
        return clean > 2 && with_labels > 2 && without_board > 2 && of_livox > 2;
      }))
      << clean << ' ' << with_labels << ' ' << without_board << ' ' << of_livox << '\n'
      << read_file(folder.path() / "live.log");
  EXPECT_EQ(live.end(), 0);
  const auto summary = nlohmann::json::parse(read_file(folder.path() / "summary.json"));
  ASSERT_EQ(summary["clouds"].size(), 3U);
  EXPECT_EQ(summary["clouds"][0]["topic"], "/points");
  EXPECT_GT(summary["clouds"][0]["points"]["occluded"], 2);
  EXPECT_GT(summary["clouds"][1]["judged"], 2);
  EXPECT_TRUE(summary["cameras"].empty());
}

}  // namespace
}  // namespace penumbra::test
