// SPDX-License-Identifier: Apache-2.0
// ROS 2's graph against Fast DDS, ROS 2's default middleware, in another process.
#include "../support/run_length.hpp"
#include "listening.hpp"
#include "lone_domain.hpp"
#include "peer_process.hpp"

#include <functional>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr const char* ros_image = "sensor_msgs/msg/Image";
constexpr const char* peers_image = "sensor_msgs::msg::dds_::Image_";
constexpr std::size_t large = 1280 * 720 * 4 + 67;  // the last bytes fill no four

class Vendors : public testing::Test {
 protected:
  /// "publish" or "count" and more of Fast DDS on /a.
  PeerProcess peer(const std::string& mode, const std::string& qos,
                   const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {std::to_string(domain.id()), mode, "rt/a", peers_image, qos};
    words.insert(words.end(), more.begin(), more.end());
    return PeerProcess(words);
  }

  /// Waits until a subscriber and the publication know of each other.
  void begin(PeerProcess& subscriber, const io::Publication& said) const {
    ASSERT_TRUE(subscriber.says("ready"));
    ASSERT_TRUE(subscriber.says("matched"));
    ASSERT_TRUE(eventually(*graph, [&] { return said.subscribers() == 1; }));
  }

  /// Lets a publisher begin once the subscription and it know of each other.
  void begin(PeerProcess& publisher, const io::Subscription& heard) const {
    ASSERT_TRUE(publisher.says("ready"));
    ASSERT_TRUE(publisher.says("matched"));
    ASSERT_TRUE(eventually(*graph, [&] { return heard.status().publishers == 1; }));
    publisher.go();
  }

  LoneDomain domain;
  std::unique_ptr<io::Participant> graph = io::join_graph({.domain = domain.id()});
};

constexpr struct {
  bool reliable;
  std::size_t size;
  std::uint32_t count;
} both_ways[] = {
    {true, 12, 20}, {false, 12, 20}, {true, 65'537, 20}, {true, large, 15}, {false, 100'003, 15}};

std::string qos_of(bool reliable) {
  return reliable ? "reliable,depth=50" : "best_effort,depth=50";
}

// The first message may be missed: if a part of it is dropped before the publisher's first
// heartbeat, a subscription that is not latched takes it for one from before they met.
TEST_F(Vendors, FromFastDdsEveryByteArrives) {
  for (const auto& [reliable, size, count] : both_ways) {
    SCOPED_TRACE(qos_of(reliable) + " " + std::to_string(size));
    const auto heard = graph->subscribe("/a", ros_image, {.reliable = reliable, .depth = 50});
    auto other =
        peer("publish", qos_of(reliable), {std::to_string(size), std::to_string(count), "30"});
    begin(other, *heard);
    std::vector<std::int64_t> numbers;
    const std::int64_t last = count - 1;
    ASSERT_TRUE(eventually(*graph, [&] {
      for (const std::int64_t number : take_numbers(*heard)) numbers.push_back(number);
      return !numbers.empty() && numbers.back() == last;
    }));
    const std::int64_t first = numbers.front();
    EXPECT_LE(first, 1);
    std::vector<std::int64_t> wanted = numbers_up_to(count);
    wanted.erase(wanted.begin(), wanted.begin() + first);
    EXPECT_EQ(numbers, wanted);
    const auto status = heard->status();
    EXPECT_EQ(status.received, wanted.size());
    EXPECT_EQ(status.taken, wanted.size());
    EXPECT_EQ(status.lost, 0U);
    EXPECT_EQ(other.end(), 0);
  }
}

TEST_F(Vendors, ToFastDdsEveryByteArrives) {
  for (const auto& [reliable, size, count] : both_ways) {
    SCOPED_TRACE(qos_of(reliable) + " " + std::to_string(size));
    const auto said = graph->advertise("/a", ros_image, {.reliable = reliable, .depth = 50});
    auto other = peer("count", qos_of(reliable));
    begin(other, *said);
    for (std::uint32_t i = 0; i < count; ++i) {
      ASSERT_TRUE(said->write(pattern_message(i, size)));
      ASSERT_TRUE(other.says(std::to_string(i) + " " + std::to_string(size)));
    }
    EXPECT_EQ(other.end(), 0);
  }
}

TEST_F(Vendors, MessagesOfManyDatagramsAt30HzAreAcknowledged) {
  const auto said = graph->advertise("/a", ros_image, {.reliable = true, .depth = 10});
  auto other = peer("count", qos_of(true));
  begin(other, *said);
  constexpr std::uint32_t count = 60;
  for (std::uint32_t i = 0; i < count; ++i) {
    ASSERT_TRUE(said->write(pattern_message(i, 300'000)));
    ASSERT_TRUE(other.says(std::to_string(i) + " 300000"));
    std::this_thread::sleep_for(std::chrono::milliseconds(33));
  }
  // All but the first would count if nobody asked for acknowledgements; some may be late.
  EXPECT_LT(said->unacknowledged(), count / 2);
}

TEST_F(Vendors, WhoComesLateGetsLatchedMessages) {
  const auto said =
      graph->advertise("/a", ros_image, {.reliable = true, .latched = true, .depth = 1});
  for (std::uint32_t i = 0; i < 3; ++i) ASSERT_TRUE(said->write(pattern_message(i, 100'000)));
  auto late = peer("count", "reliable,latched,depth=1");
  begin(late, *said);
  EXPECT_TRUE(late.says("2 100000"));
}

TEST_F(Vendors, ComingLateLatchedMessagesAreHad) {
  auto early = peer("publish", "reliable,latched,depth=1", {"100000", "3", "1000"});
  ASSERT_TRUE(early.says("ready"));
  early.go();
  ASSERT_TRUE(early.says("written 3"));
  const auto heard =
      graph->subscribe("/a", ros_image, {.reliable = true, .latched = true, .depth = 1});
  EXPECT_EQ(listen(*graph, *heard, 1), (std::vector<std::int64_t>{2}));
}

TEST_F(Vendors, QosThatDoesNotFitIsToldByPolicy) {
  const auto heard = graph->subscribe("/a", ros_image, {.reliable = true});
  const auto latched = graph->subscribe("/a", ros_image, {.latched = true});
  auto other = peer("publish", "best_effort", {"100", "1000", "100"});
  ASSERT_TRUE(eventually(
      *graph, [&] { return heard->status().refused > 0 && latched->status().refused > 0; }));
  EXPECT_EQ(heard->status().refused_because, "reliability");
  EXPECT_EQ(latched->status().refused_because, "durability");
  EXPECT_EQ(heard->status().publishers, 0);
  EXPECT_EQ(heard->status().received, 0U);
  const auto topics = graph->graph();
  ASSERT_EQ(topics.size(), 1U);
  ASSERT_EQ(topics[0].publishers.size(), 1U);
  EXPECT_FALSE(topics[0].publishers[0].qos.reliable);
  EXPECT_FALSE(topics[0].publishers[0].own);
  EXPECT_NE(topics[0].publishers[0].host, "");
}

TEST_F(Vendors, APublisherThatIsKilledMayComeBack) {
  const auto heard = graph->subscribe("/a", ros_image, {.reliable = true, .depth = 100});
  {
    auto first = peer("publish", "reliable", {"1000", "1000000", "100"});
    begin(first, *heard);
    EXPECT_GE(listen(*graph, *heard, 10).size(), 10U);
    first.kill();
  }
  // Its lease is 3 s.
  EXPECT_TRUE(eventually(*graph, [&] {
    static_cast<void>(take_numbers(*heard));
    return heard->status().publishers == 0;
  }));
  auto second = peer("publish", "reliable", {"1000", "20", "100"});
  begin(second, *heard);
  EXPECT_EQ(listen(*graph, *heard, 20), numbers_up_to(20));
}

// A socket's buffer that is smaller than a message, which comes in datagrams of 64 KB.
TEST(VendorsLoss, WhatIsDroppedOnTheWayIsCounted) {
  if (sanitized) GTEST_SKIP() << "skipped: how much arrives is a matter of time";
  const LoneDomain domain;
  setenv(
      "CYCLONEDDS_URI",
      "<CycloneDDS><Domain><Internal><SocketReceiveBufferSize max=\"200kB\"/></Internal></Domain>"
      "</CycloneDDS>",
      1);
  const auto graph = io::join_graph({.domain = domain.id()});
  unsetenv("CYCLONEDDS_URI");
  const auto heard = graph->subscribe("/a", ros_image, {.depth = 1000});
  std::vector<std::int64_t> numbers;
  constexpr int most_publishers = 50;  // on a busy machine all messages of one may be lost
  for (int i = 0; i < most_publishers && numbers.empty(); ++i) {
    PeerProcess other({std::to_string(domain.id()), "publish", "rt/a", peers_image, "best_effort",
                       "600000", "200", "100"});
    ASSERT_TRUE(other.says("ready"));
    ASSERT_TRUE(other.says("matched"));
    other.go();
    ASSERT_TRUE(other.says("written 200"));
    numbers = take_numbers(*heard);
  }
  ASSERT_FALSE(numbers.empty());
  EXPECT_GE(numbers.front(), 0);
  EXPECT_EQ(std::ranges::adjacent_find(numbers, std::ranges::greater_equal()), numbers.end());
  const auto span = static_cast<std::uint64_t>(numbers.back() - numbers.front());
  const std::uint64_t gaps = span + 1 - numbers.size();
  EXPECT_GT(gaps, 0U);
  EXPECT_EQ(heard->status().lost, gaps);
  EXPECT_EQ(heard->status().received, numbers.size());
}

}  // namespace
}  // namespace penumbra::test
