// SPDX-License-Identifier: Apache-2.0
// What penumbra live subscribes to and publishes on the graph, and under which names.
#include "../support/temporary_folder.hpp"
#include "listening.hpp"
#include "live_program.hpp"
#include "lone_domain.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <apps/penumbra/live_graph.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::test {
namespace {

constexpr const char* image = "sensor_msgs/msg/Image";
constexpr std::uint32_t more = 50;  // images than a subscription keeps

/// A live camera's subscriptions, and somebody who sends it color images.
class LiveColor : public testing::Test {
 protected:
  static io::LiveOptions options() {
    io::LiveOptions options;
    options.cameras = {
        {.depth_topic = "/depth", .info_topic = "/camera_info", .color_topic = "/color"}};
    return options;
  }
  [[nodiscard]] io::LiveLink color() const {
    const auto links = subscriptions_.links();
    std::size_t at = links.size();
    runner_.with_inbox([&](const io::LiveInbox& inbox) {
      for (std::size_t i = 0; i < links.size(); ++i)
        if (inbox.topics()[i].name == "/color") at = i;
      return true;
    });
    return links.at(at);
  }
  /// So many images while nobody reads, in place of which the last ones stay.
  void overwrite(std::uint32_t images) {
    ASSERT_TRUE(eventually(*other_, [&] { return publisher_->subscribers() == 1; }));
    const std::uint64_t before = color().overwritten;
    const io::TopicQos qos = app::live_qos({.role = io::LiveRole::color}, true);
    const auto kept = static_cast<std::uint32_t>(qos.depth);
    for (std::uint32_t i = 0; i < images; ++i)
      ASSERT_TRUE(publisher_->write(pattern_message(i, 1000)));
    EXPECT_TRUE(eventually(*other_, [&] { return color().overwritten == before + images - kept; }));
  }

  LoneDomain domain_;
  std::unique_ptr<io::Participant> graph_ = io::join_graph({.domain = domain_.id()});
  std::unique_ptr<io::Participant> other_ = io::join_graph({.domain = domain_.id()});
  std::unique_ptr<io::Publication> publisher_ =
      other_->advertise("/color", image, {.reliable = true, .depth = 2 * more});
  mutable io::LiveRunner runner_{options(), PipelineConfig{}, {}};
  app::LiveSubscriptions subscriptions_{*graph_, runner_, true};
};

/// Color is subscribed to as long as somebody wants overlays.
TEST_F(LiveColor, WhatWasMissedStaysCountedWhenNobodyWantsOverlaysAnyMore) {
  subscriptions_.follow(true);
  ASSERT_NO_FATAL_FAILURE(overwrite(more));
  const std::uint64_t missed = color().overwritten;
  EXPECT_GT(missed, 0U);
  subscriptions_.follow(false);
  EXPECT_FALSE(color().is_open);
  EXPECT_EQ(color().overwritten, missed);
  subscriptions_.follow(true);
  EXPECT_TRUE(color().is_open);
  EXPECT_EQ(color().overwritten, missed);
  ASSERT_NO_FATAL_FAILURE(overwrite(more / 2));
  EXPECT_GT(color().overwritten, missed);
}

TEST(LiveNames, DiagnosticsAreRemapped) {
  const LoneDomain domain;
  const TemporaryFolder folder;
  const auto graph = io::join_graph({.domain = domain.id()});
  const auto heard =
      graph->subscribe("/cell/health", "diagnostic_msgs/msg/DiagnosticArray", {.reliable = true});
  LiveProgram live({"--domain", std::to_string(domain.id()), "--depth-topic", "/depth", "--remap",
                    "/diagnostics:=/cell/health"},
                   folder.path() / "live.log");
  io::Sample sample;
  ASSERT_TRUE(eventually(*graph, [&] { return heard->take(sample); }));
  io::DiagnosticArrayMessage message;
  ASSERT_FALSE(io::Decoder<io::DiagnosticArrayMessage>().decode(sample.data, message));
  EXPECT_FALSE(message.status.empty());
  const auto topics = graph->graph();
  EXPECT_TRUE(std::none_of(topics.begin(), topics.end(),
                           [](const auto& topic) { return topic.name == "/diagnostics"; }));
  EXPECT_EQ(live.end(), 0);
}

}  // namespace
}  // namespace penumbra::test
