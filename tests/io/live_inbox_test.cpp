// SPDX-License-Identifier: Apache-2.0
// What is judged of messages as they come, driven by hand.
#include "live_inbox_bench.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

TEST_F(LiveInboxTest, JudgesAnImageAtItsStamp) {
  bench_.tell_all();
  EXPECT_EQ(judge(start), 1U);
  for (const io::ResultTopic& topic : io::result_topics)
    EXPECT_EQ(bench_.results.count(topic.result), 1U) << topic.name;
  EXPECT_EQ(status(), "ok");
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 1U);
  const auto labels = bench_.results.last<io::ImageMessage>(io::Result::labels);
  EXPECT_EQ(labels.header.stamp, start);
  EXPECT_EQ(labels.header.frame_id, "optical");
}

TEST_F(LiveInboxTest, AnotherPoseWouldShow) {
  // The oracle of these tests: 30 ms make other labels.
  const FrameReport& report = truth_.judge(start);
  const std::vector<std::uint8_t> labels(report.labels.data, report.labels.data + 64 * 48);
  const FrameReport& later = truth_.judge(start + 30 * milliseconds);
  EXPECT_NE(std::memcmp(labels.data(), later.labels.data, labels.size()), 0);
}

/// The board turns ever faster: held, of the latest state or gone on as before it is elsewhere.
TEST_F(LiveInboxTest, APoseLiesBetweenTheStatesAroundItsStamp) {
  bench_.tell_all();
  for (const auto& [ms, angle] : {std::pair(-30, 0.0), {-20, 0.0}, {-10, 0.1}, {10, 0.5}})
    bench_.tell(
        "/joint_states",
        encoded(io::JointStateMessage{
            .header = {start + ms * milliseconds, ""}, .names = {"spin"}, .positions = {angle}}));
  bench_.tell_depth(start);
  ASSERT_EQ(bench_.work(), 1U);
  const auto labels = bench_.results.last<io::ImageMessage>(io::Result::labels);
  const auto is_turned = [&](double angle) {
    const auto when = start + std::llround(angle / std::numbers::pi * 1e9);  // spin_at's pace
    return std::memcmp(labels.data.data(), truth_.judge(when).labels.data, labels.data.size()) == 0;
  };
  EXPECT_TRUE(is_turned(0.3));
  for (const double other : {0.0, 0.1, 0.2, 0.5}) EXPECT_FALSE(is_turned(other)) << other;
}

TEST_F(LiveInboxTest, OnlyWhatIsWantedIsMade) {
  bench_.results.wanted = {{io::Result::overlay, false}, {io::Result::points, false}};
  bench_.tell_all();
  judge(start);
  EXPECT_EQ(bench_.results.count(io::Result::overlay), 0U);
  EXPECT_EQ(bench_.results.count(io::Result::points), 0U);
  EXPECT_EQ(bench_.results.count(io::Result::mask), 1U);
}

TEST_F(LiveInboxTest, NothingIsPublishedBeforeRobotAndCameraAreKnown) {
  bench_.tell_depth(start);
  bench_.tell_robot();
  bench_.tell_depth(start + milliseconds);
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::not_ready), 2U);
  bench_.tell_info(0);
  bench_.tell_mount();
  EXPECT_EQ(judge(start + 2 * milliseconds), 1U);
}

TEST_F(LiveInboxTest, WithoutJointStatesAllIsUnknown) {
  bench_.tell_all();
  bench_.tell_depth(start);
  EXPECT_EQ(bench_.work(), 0U) << "they may still come";
  bench_.now += 200 * milliseconds;
  EXPECT_EQ(bench_.work(), 1U);
  EXPECT_EQ(status(), "missing_joints");
  EXPECT_EQ(bench_.results.count(io::Result::virtual_depth), 0U);
  expect_nothing_trusted();
}

/// A joint_state_publisher whose sliders nobody moves.
std::vector<std::byte> sliders(std::int64_t stamp) {
  return encoded(io::JointStateMessage{
      .header = {stamp, ""}, .names = {"spin"}, .positions = {spin_at(start) + 2.0}});
}

TEST_F(LiveInboxTest, TwoPublishersThatDisagreeAreNoPose) {
  bench_.tell_all();
  for (std::int64_t ago = 300; ago >= -20; ago -= 20) {
    bench_.tell_joints(start - ago * milliseconds, 7);
    bench_.tell("/joint_states", sliders(start - (ago - 7) * milliseconds), 8);
  }
  bench_.tell_depth(start);
  ASSERT_EQ(bench_.work(), 1U) << "it does not wait";
  EXPECT_EQ(status(), "poses_disagree");
  expect_nothing_trusted();
  EXPECT_EQ(bench_.results.count(io::Result::virtual_depth), 0U);
  const std::string message = bench_.inbox.tally(0).last.message;
  for (const char* const part : {"'spin'", "publisher 1 of /joint_states (joint 'spin')",
                                 "publisher 2 of /joint_states (joint 'spin')"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  // The sliders end, and a second later all is well.
  const std::int64_t later = start + seconds;
  for (std::int64_t t = start + 40 * milliseconds; t <= later + 20 * milliseconds;
       t += 20 * milliseconds)
    bench_.tell_joints(t, 7);
  bench_.results.published.clear();
  bench_.tell_depth(later);
  ASSERT_EQ(bench_.work(), 1U);
  EXPECT_EQ(status(), "ok");
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 1U);
}

TEST_F(LiveInboxTest, PublishersThatAgreeAndADriverThatStartsAgainAreWell) {
  bench_.tell_all();
  std::size_t known = 0;
  for (std::int64_t ms = 0; ms < 2000; ms += 10) {
    const std::int64_t t = start + ms * milliseconds;
    if (ms < 800 || ms > 900) bench_.tell_joints(t, ms < 800 ? 7 : 9);  // killed, and started again
    if (ms % 50 == 0) bench_.tell_joints(t - 2 * milliseconds, 8);
    if (ms % 100 == 30) bench_.tell_depth(t - 5 * milliseconds);
    bench_.now += 10 * milliseconds;
    known += bench_.work();
  }
  EXPECT_EQ(known, 19U);
  const auto& statuses = bench_.inbox.tally(0).statuses;
  EXPECT_EQ(statuses.size(), 2U) << "three are stale, until the first driver counts as silent";
  EXPECT_EQ(statuses.count("ok"), 1U);
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 16U);
}

TEST_F(LiveInboxTest, PublishersOfAPlayedBagAreDistinguishedByTheirMessages) {
  // One publisher plays the messages of two programs.
  bench_.tell_all();
  for (std::int64_t ago = 300; ago >= -20; ago -= 20) {
    bench_.tell_joints(start - ago * milliseconds, 7);
    bench_.tell("/joint_states",
                encoded(io::JointStateMessage{.header = {start - (ago - 7) * milliseconds, ""},
                                              .names = {"spin", "other"},
                                              .positions = {0.0, 0.0}}),
                7);
  }
  bench_.tell_depth(start);
  ASSERT_EQ(bench_.work(), 1U);
  EXPECT_EQ(status(), "poses_disagree");
}

TEST_F(LiveInboxTest, WithoutTheCamerasTransformAllIsUnknown) {
  bench_.tell_robot();
  bench_.tell_info(0);
  tell_joints_around(start);
  bench_.tell_depth(start);
  bench_.now += 200 * milliseconds;
  EXPECT_EQ(bench_.work(), 1U);
  EXPECT_EQ(status(), "missing_transform");
  expect_nothing_trusted();
  bench_.tell_mount();
  EXPECT_EQ(judge(start + 300 * milliseconds), 1U);
  EXPECT_EQ(status(), "ok");
}

TEST_F(LiveInboxTest, TheNewestImageWins) {
  bench_.tell_all();
  for (int i = 0; i < 4; ++i) {
    tell_joints_around(start + i * 33 * milliseconds);
    bench_.tell_depth(start + i * 33 * milliseconds);
  }
  EXPECT_EQ(bench_.work(), 1U);
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::superseded), 3U);
  EXPECT_EQ(bench_.results.last<io::ImageMessage>(io::Result::labels).header.stamp,
            start + 99 * milliseconds);
}

TEST_F(LiveInboxTest, AnotherCameraInfoMakesAnotherCamera) {
  bench_.tell_all();
  bench_.tell_info(start);
  EXPECT_EQ(judge(start), 1U);
  // An image of the old camera that waits when the new one is told is not judged by either.
  bench_.tell_depth(start + 33 * milliseconds);
  bench_.tell_info(start + 66 * milliseconds, 90.0);
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::changed), 1U);
  bench_.tell_depth(start + 50 * milliseconds);
  EXPECT_EQ(bench_.work(), 0U) << "it is from before the change";
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::changed), 2U);
  bench_.results.published.clear();
  EXPECT_EQ(judge(start + 66 * milliseconds), 1U);
  LiveTruth other({.focal = 90.0});
  EXPECT_EQ(expect_true_labels(bench_.results.published, other), 1U);
  EXPECT_EQ(bench_.inbox.camera(0).camera_changes(), 1U);
}

TEST_F(LiveInboxTest, TheSameRobotAgainIsNothingNew) {
  bench_.tell_all();
  judge(start);
  const io::LiveSetup* const setup = bench_.inbox.camera(0).setup();
  bench_.tell_robot();
  EXPECT_EQ(bench_.inbox.camera(0).setup(), setup);
  EXPECT_EQ(bench_.inbox.robot().robots(), 1U);
}

TEST_F(LiveInboxTest, ABrokenRobotEndsTheResults) {
  bench_.tell_all();
  EXPECT_EQ(judge(start), 1U);
  bench_.tell_robot("<robot name=\"half\"><link name=\"base\"/>");
  EXPECT_NE(bench_.inbox.robot().fault(), "");
  EXPECT_EQ(judge(start + 33 * milliseconds), 0U) << "the old robot is not there any more";
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::not_ready), 1U);
  bench_.tell_robot();
  EXPECT_EQ(judge(start + 66 * milliseconds), 1U);
  EXPECT_EQ(status(), "ok");
}

TEST_F(LiveInboxTest, ARobotThatCouldNotBeMadeIsTriedAgain) {
  bench_.tell_mount();
  bench_.tell_info(0);
  const auto text = encoded(io::StringMessage{live_urdf});
  bench_.tell("/robot_description", text);
  auto order = bench_.inbox.take_order();
  ASSERT_TRUE(order);
  bench_.tell("/robot_description", text);
  EXPECT_FALSE(bench_.inbox.take_order()) << "it is being made";
  bench_.inbox.place({order->number, nullptr, "its meshes are not there"});
  bench_.tell("/robot_description", text);
  order = bench_.inbox.take_order();
  ASSERT_TRUE(order) << "told again";
  EXPECT_EQ(bench_.inbox.robot().fault(), "its meshes are not there") << "until it is made";
  bench_.inbox.place({order->number, nullptr, "nor now"});
  bench_.inbox.retry_robot();
  order = bench_.inbox.take_order();
  ASSERT_TRUE(order);
  bench_.inbox.place(io::make_robot(*order));
  EXPECT_EQ(bench_.inbox.robot().fault(), "");
  bench_.inbox.retry_robot();
  EXPECT_FALSE(bench_.inbox.take_order());
  EXPECT_EQ(judge(start), 1U);
}

TEST_F(LiveInboxTest, AnotherRobotIsDrawn) {
  bench_.tell_all();
  judge(start);
  std::string larger = live_urdf;
  larger.replace(larger.find("0.4 0.2 0.1"), 11, "0.8 0.8 0.1");
  const auto pixels = [&] {
    const auto mask = bench_.results.last<io::ImageMessage>(io::Result::mask);
    return std::count(mask.data.begin(), mask.data.end(), std::byte{255});
  };
  const auto before = pixels();
  bench_.tell_robot(larger);
  judge(start + 33 * milliseconds);
  EXPECT_EQ(status(), "ok") << "the static transforms are not told again";
  EXPECT_GT(pixels(), 3 * before);
}

TEST_F(LiveInboxTest, RecoversFromAClockThatJumpsBack) {
  bench_.tell_all();
  EXPECT_EQ(judge(start), 1U);
  bench_.results.published.clear();
  EXPECT_EQ(judge(start - 500 * seconds), 1U);
  EXPECT_EQ(judge(start - 500 * seconds + 33 * milliseconds), 1U);
  EXPECT_EQ(status(), "ok");
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 2U);
}

TEST_F(LiveInboxTest, UnreadableMessagesAreCountedAndSaid) {
  bench_.tell_all();
  const std::vector<std::byte> half(10, std::byte{1});
  bench_.tell("/camera/depth/image_rect_raw", half);
  bench_.tell("/joint_states", half);
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::unreadable), 1U);
  EXPECT_EQ(bench_.inbox.faults().of("/joint_states"), 1U);
  EXPECT_EQ(judge(start), 1U);
}

TEST_F(LiveInboxTest, ImagesOfAnotherSizeAreBadDepth) {
  bench_.tell_all();
  judge(start);
  const Image<std::uint16_t> small(32, 24, 900);
  tell_joints_around(start + 33 * milliseconds);
  bench_.tell("/camera/depth/image_rect_raw",
              encoded(io::image_message(io::MessageHeader{start + 33 * milliseconds, "optical"},
                                        "16UC1", small.view())));
  bench_.work();
  EXPECT_EQ(status(), "bad_depth");
  EXPECT_EQ(judge(start + 66 * milliseconds), 1U);
  EXPECT_EQ(status(), "ok");
}

TEST_F(LiveInboxTest, ImagesOfAnotherFrameThanTheirCameraInfoAreRefused) {
  bench_.tell_all();
  tell_joints_around(start);
  bench_.tell("/camera/depth/image_rect_raw", live_depth(start, "elsewhere"));
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_NE(bench_.inbox.camera(0).setup_fault().find("elsewhere"), std::string::npos);
  EXPECT_EQ(judge(start + 33 * milliseconds), 1U);
}

TEST_F(LiveInboxTest, EveryImageIsAccountedFor) {
  bench_.tell_all();
  for (int i = 0; i < 20; ++i) {
    const std::int64_t stamp = start + i * 33 * milliseconds;
    if (i % 3 == 0) tell_joints_around(stamp);
    bench_.tell_depth(i == 7 ? 0 : stamp);
    bench_.now += 33 * milliseconds;
    if (i % 2 == 0) bench_.work();
  }
  const io::LiveCounts counts = bench_.counts();
  std::size_t all = counts.judged + counts.failed + counts.waiting + counts.in_work;
  for (const std::size_t dropped : counts.dropped) all += dropped;
  EXPECT_EQ(counts.received, 20U);
  EXPECT_EQ(all, 20U);
}

}  // namespace
}  // namespace penumbra::test
