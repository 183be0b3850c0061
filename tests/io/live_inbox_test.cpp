// SPDX-License-Identifier: Apache-2.0
// An inbox driven by hand: which images are judged, and how.
#include "live_scene.hpp"
#include "ros_images.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

class LiveInboxTest : public testing::Test {
 protected:
  /// Publishes joint states before and after a stamp.
  void tell_joints_around(std::int64_t stamp) {
    bench_.tell_joints(stamp - 10 * milliseconds);
    bench_.tell_joints(stamp + 10 * milliseconds);
  }
  /// Judges an image whose pose is known.
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
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 1U);
  const auto labels = bench_.results.last<io::ImageMessage>(io::Result::labels);
  EXPECT_EQ(labels.header.stamp, start);
  EXPECT_EQ(labels.header.frame_id, "optical");
}

TEST_F(LiveInboxTest, AnotherPoseWouldShow) {
  // Checks the oracle of these tests: labels of 30 ms later differ.
  const FrameReport& report = truth_.judge(start);
  const std::vector<std::uint8_t> labels(report.labels.data, report.labels.data + 64 * 48);
  const FrameReport& later = truth_.judge(start + 30 * milliseconds);
  EXPECT_NE(std::memcmp(labels.data(), later.labels.data, labels.size()), 0);
}

/// The board turns faster and faster, so that only interpolation gives the right pose.
TEST_F(LiveInboxTest, APoseLiesBetweenTheStatesAroundItsStamp) {
  bench_.tell_all();
  for (const auto& [ms, angle] : {std::pair(-30, 0.0), {-20, 0.0}, {-10, 0.1}, {10, 0.5}})
    bench_.publish(
        "/joint_states",
        encoded(io::JointStateMessage{
            .header = {start + ms * milliseconds, ""}, .names = {"spin"}, .positions = {angle}}));
  bench_.tell_depth(start);
  ASSERT_EQ(bench_.work(), 1U);
  const auto labels = bench_.results.last<io::ImageMessage>(io::Result::labels);
  const auto is_turned = [&](double angle) {
    const auto when = start + std::llround(angle / std::numbers::pi * 1e9);  // spin_at's speed
    return std::memcmp(labels.data.data(), truth_.judge(when).labels.data, labels.data.size()) == 0;
  };
  EXPECT_TRUE(is_turned(0.3));
  for (const double other : {0.0, 0.1, 0.2, 0.5}) EXPECT_FALSE(is_turned(other)) << other;
}

TEST_F(LiveInboxTest, NothingIsPublishedBeforeRobotAndCameraAreKnown) {
  bench_.tell_depth(start);
  bench_.tell_robot();
  bench_.tell_depth(start + milliseconds);
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_EQ(bench_.counts().of(DropReason::not_ready), 2U);
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

/// Returns a state of a joint_state_publisher whose sliders do not move.
std::vector<std::byte> sliders(std::int64_t stamp) {
  return encoded(io::JointStateMessage{
      .header = {stamp, ""}, .names = {"spin"}, .positions = {spin_at(start) + 2.0}});
}

TEST_F(LiveInboxTest, TwoPublishersThatDisagreeAreNoPose) {
  bench_.tell_all();
  for (std::int64_t ago = 300; ago >= -20; ago -= 20) {
    bench_.tell_joints(start - ago * milliseconds, 7);
    bench_.publish("/joint_states", sliders(start - (ago - 7) * milliseconds), 8);
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
  // The sliders stop. A second later the driver is believed.
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
    if (ms < 800 || ms > 900) bench_.tell_joints(t, ms < 800 ? 7 : 9);  // killed and restarted
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
  EXPECT_EQ(bench_.counts().of(DropReason::superseded), 3U);
  EXPECT_EQ(bench_.results.last<io::ImageMessage>(io::Result::labels).header.stamp,
            start + 99 * milliseconds);
}

TEST_F(LiveInboxTest, AnotherCameraInfoMakesAnotherCamera) {
  bench_.tell_all();
  bench_.tell_info(start);
  EXPECT_EQ(judge(start), 1U);
  // An image of the old camera that waits while the new one appears is judged by neither.
  bench_.tell_depth(start + 33 * milliseconds);
  bench_.tell_info(start + 66 * milliseconds, 90.0);
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_EQ(bench_.counts().of(DropReason::changed), 1U);
  bench_.tell_depth(start + 50 * milliseconds);
  EXPECT_EQ(bench_.work(), 0U) << "it is from before the change";
  EXPECT_EQ(bench_.counts().of(DropReason::changed), 2U);
  bench_.results.published.clear();
  EXPECT_EQ(judge(start + 66 * milliseconds), 1U);
  LiveTruth other({.focal = 90.0});
  EXPECT_EQ(expect_true_labels(bench_.results.published, other), 1U);
  EXPECT_EQ(bench_.inbox.camera(0).camera_changes(), 1U);
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
  EXPECT_EQ(status(), "ok") << "the static transforms are not published again";
  EXPECT_GT(pixels(), 3 * before);
}

TEST_F(LiveInboxTest, WhatIsAttachedStaysWithTheNextRobot) {
  io::AttachedObjectMessage part{.link_name = "board"};
  part.object.header = {start - seconds, "board"};
  part.object.id = "part";
  part.object.pose = {{0.5, 0, 0}, {0, 0, 0, 1}};
  part.object.primitives = {
      {.type = io::SolidPrimitiveMessage::box, .dimensions = {0.3, 0.3, 0.3}}};
  part.object.primitive_poses = {{{0, 0, 0}, {0, 0, 0, 1}}};
  const auto pixels = [&](std::int64_t stamp) {
    judge(stamp);
    const auto mask = bench_.results.last<io::ImageMessage>(io::Result::mask);
    return std::count(mask.data.begin(), mask.data.end(), std::byte{255});
  };
  bench_.publish("/attached_collision_object", encoded(part));  // before the robot is known
  bench_.tell_all();
  const auto with = pixels(start);
  bench_.tell_robot(live_urdf + std::string(" "));
  const auto with_next = pixels(start + 33 * milliseconds);
  part.object.header.stamp = start + 40 * milliseconds;
  part.object.operation = io::CollisionObjectMessage::remove;
  bench_.publish("/attached_collision_object", encoded(part));
  const auto without = pixels(start + 66 * milliseconds);
  EXPECT_EQ(status(), "ok");
  constexpr int least = 100;  // pixels of the box beside the board, which turns
  EXPECT_GT(with, without + least);
  EXPECT_GT(with_next, without + least);
}

/// Two robots: "a" is before the camera, "b" is far beside the image.
TEST(LiveRobots, HaveNamespacesAndFailAlone) {
  io::LiveOptions options = LiveBench::one_camera();
  io::set_robots(options, {"a", "b"}, [](const std::string& name) { return "/" + name; });
  LiveBench bench(options);
  LiveTruth truth;
  const auto tell_joints = [&](const char* topic, std::int64_t stamp) {
    bench.publish(topic, live_joints(stamp - 10 * milliseconds));
    bench.publish(topic, live_joints(stamp + 10 * milliseconds));
  };
  const auto status = [&] {
    return bench.results.last<io::TargetsMessage>(io::Result::targets).status;
  };
  bench.publish("/a/robot_description", encoded(io::StringMessage{live_urdf}));
  EXPECT_FALSE(bench.inbox.take_load_request()) << "b is missing";
  bench.publish("/b/robot_description", encoded(io::StringMessage{live_urdf}));
  bench.inbox.set_robot(io::make_robot(*bench.inbox.take_load_request()));
  EXPECT_NE(bench.inbox.robot().fault().find("'a/base'"), std::string::npos) << "no mount yet";
  const Eigen::Isometry3d aside(Eigen::Translation3d(100.0, 0.0, 0.0));
  bench.publish("/tf_static",
                encoded(io::TfMessage{{{{0, "world"}, "a/base"}, {{0, "a/base"}, "optical"}}}));
  const auto half = bench.inbox.take_load_request();
  ASSERT_TRUE(half) << "as soon as a transform is new";
  bench.publish("/tf_static", encoded(io::TfMessage{{{{0, "world"}, "b/base", aside}}}));
  bench.inbox.set_robot(io::make_robot(*half));
  EXPECT_NE(bench.inbox.robot().fault().find("'b/base'"), std::string::npos) << "it came later";
  bench.inbox.set_robot(io::make_robot(*bench.inbox.take_load_request()));
  EXPECT_EQ(bench.inbox.robot().fault(), "");
  bench.tell_info(0);
  tell_joints("/a/joint_states", start);
  tell_joints("/b/joint_states", start);
  bench.tell_depth(start);
  EXPECT_EQ(bench.work(), 1U);
  EXPECT_EQ(status(), "ok");

  // Both MoveIts attach an object called part; one removes all of its own.
  io::AttachedObjectMessage part{.link_name = "board"};
  part.object.header = {start + milliseconds, "board"};
  part.object.id = "part";
  part.object.pose = {{0.5, 0, 0}, {0, 0, 0, 1}};
  part.object.primitives = {
      {.type = io::SolidPrimitiveMessage::box, .dimensions = {0.3, 0.3, 0.3}}};
  part.object.primitive_poses = {{{0, 0, 0}, {0, 0, 0, 1}}};
  const auto pixels = [&](std::int64_t stamp) {
    for (const char* const topic : {"/a/joint_states", "/b/joint_states"})
      tell_joints(topic, stamp);
    bench.tell_depth(stamp);
    EXPECT_EQ(bench.work(), 1U);
    EXPECT_EQ(status(), "ok");
    const auto mask = bench.results.last<io::ImageMessage>(io::Result::mask);
    return std::count(mask.data.begin(), mask.data.end(), std::byte{255});
  };
  const auto bare = pixels(start + 40 * milliseconds);
  for (const char* const robot : {"/a", "/b"})
    bench.publish(robot + std::string("/attached_collision_object"), encoded(part));
  const auto remove_all = [&](const char* topic) {
    io::AttachedObjectMessage none;
    none.object.header.stamp = start + 90 * milliseconds;
    none.object.operation = io::CollisionObjectMessage::remove;
    bench.publish(topic, encoded(none));
  };
  constexpr int least = 100;  // pixels of the box
  EXPECT_GT(pixels(start + 80 * milliseconds), bare + least);
  remove_all("/b/attached_collision_object");
  EXPECT_GT(pixels(start + 120 * milliseconds), bare + least) << "that of a stays";
  remove_all("/a/attached_collision_object");
  EXPECT_LT(pixels(start + 160 * milliseconds), bare + least);
  bench.results.published.clear();

  const std::int64_t later = start + seconds;
  tell_joints("/a/joint_states", later);  // and b is silent
  bench.tell_depth(later);
  bench.now += seconds;
  EXPECT_EQ(bench.work(), 1U);
  EXPECT_EQ(status(), "missing_link");
  EXPECT_EQ(expect_true_labels(bench.results.published, truth), 1U);

  tell_joints("/b/joint_states", later + seconds);  // and a, which carries the camera, is silent
  bench.tell_depth(later + seconds);
  bench.now += seconds;
  EXPECT_EQ(bench.work(), 1U);
  EXPECT_EQ(status(), "stale_joints");
}

/// A calibration is published anew while the robots work.
TEST(LiveRobots, AreDrawnWhereTheirBasesWerePublishedLast) {
  io::LiveOptions options = LiveBench::one_camera();
  io::set_robots(options, {"a", "b"}, [](const std::string& name) { return "/" + name; });
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 0.0)); };
  const auto labels_of = [&](double first, double last) {
    LiveBench bench(options);
    const auto tell_base = [&](const std::string& frame, double x) {
      bench.publish("/tf_static", encoded(io::TfMessage{{{{0, "world"}, frame, at(x)}}}));
    };
    tell_base("optical", 0.0);
    tell_base("a/base", -0.3);
    tell_base("b/base", first);
    for (const char* const robot : {"/a", "/b"})
      bench.publish(robot + std::string("/robot_description"),
                    encoded(io::StringMessage{live_urdf}));
    bench.inbox.set_robot(io::make_robot(*bench.inbox.take_load_request()));
    bench.tell_info(0);
    if (last != first) tell_base("b/base", last);
    for (const char* const robot : {"/a", "/b"})
      for (const std::int64_t by : {-10, 10})
        bench.publish(robot + std::string("/joint_states"), live_joints(start + by * milliseconds));
    bench.tell_depth(start);
    EXPECT_EQ(bench.work(), 1U);
    EXPECT_EQ(bench.results.last<io::TargetsMessage>(io::Result::targets).status, "ok");
    const auto labels = bench.results.last<io::ImageMessage>(io::Result::labels);
    return std::vector(labels.data.begin(), labels.data.end());
  };
  const auto moved = labels_of(0.2, 0.3);
  EXPECT_EQ(moved, labels_of(0.3, 0.3));
  EXPECT_NE(moved, labels_of(0.2, 0.2)) << "the oracle of this test";
}

/// The messages' stamps are not those of their events: one was made earlier and sent again.
TEST_F(LiveInboxTest, WhatIsDetachedAndAttachedWithOldStampsHoldsFromNowOn) {
  io::AttachedObjectMessage part{.link_name = "board"};
  part.object.header = {start - 5 * milliseconds, "board"};
  part.object.id = "part";
  part.object.pose = {{0.5, 0, 0}, {0, 0, 0, 1}};
  part.object.primitives = {
      {.type = io::SolidPrimitiveMessage::box, .dimensions = {0.3, 0.3, 0.3}}};
  part.object.primitive_poses = {{{0, 0, 0}, {0, 0, 0, 1}}};
  bench_.tell_all();
  const auto pixels = [&](std::int64_t stamp) {
    judge(stamp);
    EXPECT_EQ(status(), "ok");
    const auto mask = bench_.results.last<io::ImageMessage>(io::Result::mask);
    return std::count(mask.data.begin(), mask.data.end(), std::byte{255});
  };
  const auto publish = [&](std::int64_t stamp, std::uint8_t operation, const std::string& id) {
    io::AttachedObjectMessage message = part;
    message.object.header.stamp = stamp;
    message.object.operation = operation;
    message.object.id = id;
    bench_.publish("/attached_collision_object", encoded(message));
  };
  using Object = io::CollisionObjectMessage;
  constexpr int least = 100;  // pixels of the box beside the board, which turns
  std::int64_t now = start;
  const auto next = [&] { return pixels(now += 33 * milliseconds); };
  const auto bare = next();
  for (const char* const id : {"part", ""}) {
    publish(now + milliseconds, Object::add, "part");
    EXPECT_GT(next(), bare + least);
    publish(start - seconds, Object::remove, id);  // before it was attached
    EXPECT_LT(next(), bare + least) << "named '" << id << "'";
    EXPECT_LT(next(), bare + least);
    publish(start - 5 * milliseconds, Object::add, "part");  // before it was detached
    EXPECT_GT(next(), bare + least);
    publish(now + milliseconds, Object::remove, "part");
    EXPECT_LT(next(), bare + least);
  }
  // One message sent again and again, with the stamp at which the part was made.
  for (int i = 0; i < 3; ++i) {
    publish(start - 2 * seconds, Object::add, "part");
    EXPECT_GT(next(), bare + least) << i;
    publish(start - 2 * seconds, Object::remove, "part");
    EXPECT_LT(next(), bare + least) << i;
  }
  // A scene that is late, as the answer to a question, says what was attached then.
  io::PlanningSceneMessage scene;
  scene.robot_state.joints.header.stamp = start;
  scene.robot_state.joints.names = {"spin"};
  scene.robot_state.attached = {part};
  bench_.publish("/monitored_planning_scene", encoded(scene));
  EXPECT_LT(next(), bare + least);
}

TEST_F(LiveInboxTest, ImagesOfAnotherSizeAreBadDepth) {
  bench_.tell_all();
  judge(start);
  const Image<std::uint16_t> small(32, 24, 900);
  tell_joints_around(start + 33 * milliseconds);
  bench_.publish("/camera/depth/image_rect_raw",
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
  bench_.publish("/camera/depth/image_rect_raw", live_depth(start, "elsewhere"));
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_NE(bench_.inbox.camera(0).setup_fault().find("elsewhere"), std::string::npos);
  EXPECT_EQ(judge(start + 33 * milliseconds), 1U);
}

/// A camera that sends a camera_info with each image is replaced by another one, whose camera_info
/// arrives a second later than its images.
TEST_F(LiveInboxTest, NoImageIsJudgedByTheCameraInfoOfTheDriverBefore) {
  bench_.tell_all();
  const auto drive = [&](std::int64_t from, int images, double focal, std::uint64_t publisher) {
    std::size_t judged = 0;
    for (int i = 0; i < images; ++i) {
      const std::int64_t stamp = from + i * 33 * milliseconds;
      if (focal > 0)
        bench_.publish("/camera/depth/camera_info", encoded(live_info(stamp, {.focal = focal})),
                       publisher);
      tell_joints_around(stamp);
      bench_.publish("/camera/depth/image_rect_raw", live_depth(stamp), publisher);
      bench_.now += 33 * milliseconds;
      judged += bench_.work();
    }
    return judged;
  };
  EXPECT_EQ(drive(start, 5, 60.0, 1), 5U);
  bench_.results.published.clear();
  EXPECT_EQ(drive(start + seconds, 30, 0.0, 2), 0U);
  bench_.now += 200 * milliseconds;
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_EQ(bench_.counts().of(DropReason::no_camera_info), 30U);
  EXPECT_EQ(bench_.inbox.camera(0).without_info(), 30U);
  EXPECT_EQ(drive(start + 2 * seconds, 3, 90.0, 2), 3U);
  EXPECT_EQ(bench_.inbox.camera(0).without_info(), 0U);
  LiveTruth other({.focal = 90.0});
  EXPECT_EQ(expect_true_labels(bench_.results.published, other), 3U);
  // Again after the clock was reset: earlier stamps are larger than all later ones.
  bench_.results.published.clear();
  EXPECT_EQ(drive(start - 900 * seconds, 10, 0.0, 3), 0U);
  EXPECT_EQ(drive(start - 899 * seconds, 3, 60.0, 3), 3U);
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 3U);
}

TEST_F(LiveInboxTest, CameraInfosThatComeOnceOrSeldomHoldForAllImages) {
  bench_.tell_all();
  std::size_t judged = 0;
  for (int i = 0; i < 60; ++i) {
    const std::int64_t stamp = start + i * 33 * milliseconds;
    if (i % 30 == 10) bench_.tell_info(stamp);  // of an image's stamp, once a second
    tell_joints_around(stamp);
    bench_.tell_depth(stamp);
    bench_.now += 33 * milliseconds;
    judged += bench_.work();
  }
  bench_.now += 200 * milliseconds;
  judged += bench_.work();
  const io::ImageCounts counts = bench_.counts();
  EXPECT_EQ(counts.of(DropReason::no_camera_info), 0U);
  EXPECT_EQ(judged + counts.of(DropReason::superseded), 60U);
  EXPECT_GT(judged, 50U);
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), judged);
}

/// Where there is no depth, the robot is unknown and everything else is clear.
TEST_F(LiveInboxTest, CompressedDepthIsJudgedAsWhatItHolds) {
  for (const bool rvl : {false, true}) {
    io::LiveOptions options = LiveBench::one_camera();
    const std::string topic = options.cameras[0].depth_topic += "/compressedDepth";
    LiveBench bench(options);
    bench.tell_all();
    const auto data = compressed_depth(Image<std::uint16_t>(64, 48, 3000), rvl, 0, 0);
    const std::string format = std::string("16UC1; compressedDepth") + (rvl ? " rvl" : " png");
    const auto judge = [&](std::int64_t stamp, std::size_t bytes) {
      bench.tell_joints(stamp - 10 * milliseconds);
      bench.tell_joints(stamp + 10 * milliseconds);
      bench.publish(topic, encoded(io::CompressedImageMessage{
                               {stamp, "optical"}, format, std::span(data).first(bytes)}));
      EXPECT_EQ(bench.work(), 1U);
      return bench.results.last<io::TargetsMessage>(io::Result::targets).status;
    };
    EXPECT_EQ(judge(start, data.size()), "ok");
    EXPECT_EQ(expect_true_labels(bench.results.published, truth_), 1U);
    const std::int64_t next = start + 33 * milliseconds;
    EXPECT_EQ(judge(next, data.size() / 2), "bad_depth");
    const auto labels = bench.results.last<io::ImageMessage>(io::Result::labels);
    for (const std::byte label : labels.data)
      ASSERT_EQ(label, static_cast<std::byte>(Label::unknown));
  }
}

TEST_F(LiveInboxTest, PosesComeFromTfInPlaceOfJointStates) {
  io::LiveOptions options = LiveBench::one_camera();
  options.poses = options.cameras[0].poses = PoseSource::transforms;
  LiveBench bench(options);
  bench.tell_all();
  const auto judge = [&](std::int64_t stamp) {
    bench.tell_depth(stamp);
    bench.now += 200 * milliseconds;
    EXPECT_EQ(bench.work(), 1U);
    return bench.results.last<io::TargetsMessage>(io::Result::targets).status;
  };
  for (int i = 0; i < 30; ++i) {
    const std::int64_t stamp = start + i * 67 * milliseconds;
    for (const std::int64_t told : {stamp - 20 * milliseconds, stamp + 20 * milliseconds}) {
      const Eigen::Isometry3d pose = Eigen::Translation3d(0, 0, 1) *
                                     Eigen::AngleAxisd(spin_at(told), Eigen::Vector3d::UnitZ());
      bench.publish("/tf", encoded(io::TfMessage{{{{told, "base"}, "board", pose}}}));
    }
    EXPECT_EQ(judge(stamp), "ok") << i;
  }
  EXPECT_EQ(expect_true_labels(bench.results.published, truth_), 30U);
  EXPECT_NE(judge(start + 10 * seconds), "ok") << "the last received pose is too old";
}

}  // namespace
}  // namespace penumbra::test
