// SPDX-License-Identifier: Apache-2.0
// What is judged of messages as they come, driven by hand.
#include "live_scene.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr std::int64_t start = 1000 * seconds;

class LiveInboxTest : public testing::Test {
 protected:
  /// Joint states around a stamp, which lies between two of them.
  void tell_joints_around(std::int64_t stamp) {
    bench_.tell_joints(stamp - 10 * milliseconds);
    bench_.tell_joints(stamp + 10 * milliseconds);
  }
  /// An image whose pose is known, judged at once.
  std::size_t judge(std::int64_t stamp) {
    tell_joints_around(stamp);
    bench_.tell_depth(stamp);
    bench_.now += 33 * milliseconds;
    return bench_.work();
  }
  std::string status() {
    return bench_.results.last<io::TargetsMessage>(io::Result::targets).status;
  }
  void expect_nothing_trusted() {
    const auto mask = bench_.results.last<io::ImageMessage>(io::Result::mask);
    for (const std::byte pixel : mask.data) ASSERT_EQ(pixel, std::byte{255});
  }

  LiveBench bench_;
  LiveTruth truth_;
};

TEST_F(LiveInboxTest, JudgesAnImageAtItsStamp) {
  bench_.tell_all();
  EXPECT_EQ(judge(start), 1U);
  for (const io::ResultTopic& topic : io::result_topics)
    EXPECT_EQ(bench_.results.count(topic.result), 1U) << topic.name;
  EXPECT_EQ(status(), "ok");
  EXPECT_EQ(expect_true_labels(bench_.results.told, truth_), 1U);
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
  bench_.results.told.clear();
  EXPECT_EQ(judge(start + 66 * milliseconds), 1U);
  LiveTruth other(90.0);
  EXPECT_EQ(expect_true_labels(bench_.results.told, other), 1U);
  EXPECT_EQ(bench_.inbox.camera(0).camera_changes(), 1U);
}

TEST_F(LiveInboxTest, AnImageWaitsForItsOwnCameraInfo) {
  bench_.tell_all();
  bench_.tell_info(start);
  EXPECT_EQ(judge(start), 1U);  // camera_infos come with images
  tell_joints_around(start + 33 * milliseconds);
  bench_.tell_depth(start + 33 * milliseconds);
  EXPECT_EQ(bench_.work(), 0U);
  ASSERT_TRUE(bench_.inbox.wake_at(0));
  bench_.tell_info(start + 33 * milliseconds, 90.0);
  EXPECT_EQ(bench_.work(), 0U) << "it was told by the old camera_info";
  tell_joints_around(start + 66 * milliseconds);
  bench_.tell_depth(start + 66 * milliseconds);
  EXPECT_EQ(bench_.work(), 0U);
  bench_.now = *bench_.inbox.wake_at(0);
  EXPECT_EQ(bench_.work(), 1U) << "it waits no longer than that";
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
  bench_.results.told.clear();
  EXPECT_EQ(judge(start - 500 * seconds), 1U);
  EXPECT_EQ(judge(start - 500 * seconds + 33 * milliseconds), 1U);
  EXPECT_EQ(status(), "ok");
  EXPECT_EQ(expect_true_labels(bench_.results.told, truth_), 2U);
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

TEST_F(LiveInboxTest, TargetsComeWithTheNextImage) {
  io::LiveOptions options = LiveBench::one_camera();
  options.target_topics = {"/wrist"};
  LiveBench bench(options);
  bench.tell_all();
  for (std::size_t i = 0; i < bench.inbox.topics().size(); ++i)
    if (bench.inbox.topics()[i].role == io::LiveRole::targets)
      bench.inbox.set_type(i, "geometry_msgs/msg/PoseStamped");
  bench.tell_depth(start - seconds);
  io::PoseStampedMessage pose{.header = {start, "optical"}};
  pose.pose.translation() = Eigen::Vector3d(1.2, 0.0, 3.0);
  bench.tell("/wrist", encoded(pose));
  bench.tell_joints(start);
  bench.tell_depth(start);
  ASSERT_EQ(bench.work(), 1U);
  const auto targets = bench.results.last<io::TargetsMessage>(io::Result::targets);
  ASSERT_EQ(targets.targets.size(), 1U);
  EXPECT_EQ(targets.targets[0].name, "/wrist");
  EXPECT_EQ(targets.targets[0].verdict, io::TargetMessage::visible);
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
