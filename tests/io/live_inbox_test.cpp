// SPDX-License-Identifier: Apache-2.0
// An inbox driven by hand: which images are judged, and how.
#include "../support/errors.hpp"
#include "live_scene.hpp"

namespace penumbra::test {
namespace {

using io::Result;

constexpr std::ptrdiff_t part_pixels = 100;  // at least, next to the board

class LiveInboxTest : public testing::Test {
 protected:
  std::size_t true_labels() { return expect_true_labels(bench_.results.published, truth_); }
  /// Judges one image that waited for so long.
  void expect_all_unknown(const std::string& status, std::int64_t waited = 200 * milliseconds) {
    bench_.now += waited;
    EXPECT_EQ(bench_.work(), 1U);
    EXPECT_EQ(bench_.status(), status);
    EXPECT_EQ(bench_.masked(), 64 * 48);
    EXPECT_EQ(bench_.results.count(Result::virtual_depth), 0U);
  }
  void attach(const io::AttachedObjectMessage& part) {
    bench_.publish("/attached_collision_object", encoded(part));
  }

  LiveBench bench_;
  LiveTruth truth_;
};

TEST_F(LiveInboxTest, JudgesAnImageAtItsStamp) {
  bench_.tell_all();
  EXPECT_EQ(bench_.judge(start), 1U);
  for (const io::ResultTopic& topic : io::result_topics)
    EXPECT_EQ(bench_.results.count(topic.result), 1U) << topic.name;
  EXPECT_EQ(bench_.status(), "ok");
  EXPECT_EQ(true_labels(), 1U);
  const auto labels = bench_.results.last<io::ImageMessage>(io::Result::labels);
  EXPECT_EQ(labels.header.stamp, start);
  EXPECT_EQ(labels.header.frame_id, "optical");
}

TEST_F(LiveInboxTest, TwoPublishersThatDisagreeAreNoPose) {
  bench_.tell_all();
  for (std::int64_t ago = 300; ago >= -20; ago -= 20) {
    bench_.tell_joints(start - ago * milliseconds, 7);
    // Sliders of a joint_state_publisher, which do not move.
    bench_.publish("/joint_states",
                   live_joints(start - (ago - 7) * milliseconds, spin_at(start) + 2.0), 8);
  }
  bench_.tell_depth(start);
  expect_all_unknown("poses_disagree", 0);
  const std::string message = bench_.inbox.tally(0).last.message;
  for (const char* const part : {"'spin'", "publisher 1 of /joint_states", "publisher 2 of"})
    EXPECT_TRUE(holds(message, part));
  // The sliders stop. A second later the driver is believed.
  const std::int64_t later = start + seconds;
  for (std::int64_t t = start + 40 * milliseconds; t <= later + 20 * milliseconds;
       t += 20 * milliseconds)
    bench_.tell_joints(t, 7);
  bench_.results.published.clear();
  bench_.tell_depth(later);
  ASSERT_EQ(bench_.work(), 1U);
  EXPECT_EQ(bench_.status(), "ok");
  EXPECT_EQ(true_labels(), 1U);
}

TEST_F(LiveInboxTest, WithoutTheCamerasTransformAllIsUnknown) {
  bench_.tell_robot();
  bench_.tell_info(0);
  bench_.tell_joints_around(start);
  bench_.tell_depth(start);
  expect_all_unknown("missing_transform");
  bench_.tell_mount();
  EXPECT_EQ(bench_.judge(start + 300 * milliseconds), 1U);
  EXPECT_EQ(bench_.status(), "ok");
}

TEST_F(LiveInboxTest, AnImageThatWaitsWhileTheCameraChangesIsJudgedByNeither) {
  bench_.tell_all();
  bench_.tell_info(start);
  EXPECT_EQ(bench_.judge(start), 1U);
  bench_.tell_depth(start + image_period);
  bench_.tell_info(start + 66 * milliseconds, 90.0);
  EXPECT_EQ(bench_.work(), 0U);
  bench_.tell_depth(start + 50 * milliseconds);
  EXPECT_EQ(bench_.work(), 0U) << "it is from before the change";
  EXPECT_EQ(bench_.counts().of(DropReason::changed), 2U);
}

TEST_F(LiveInboxTest, AnotherRobotIsDrawn) {
  bench_.tell_all();
  bench_.judge(start);
  std::string larger = live_urdf;
  larger.replace(larger.find("0.4 0.2 0.1"), 11, "0.8 0.8 0.1");
  const auto before = bench_.masked();
  bench_.tell_robot(larger);
  bench_.judge(start + image_period);
  EXPECT_EQ(bench_.status(), "ok") << "the static transforms are not published again";
  EXPECT_GT(bench_.masked(), 3 * before);
}

TEST_F(LiveInboxTest, WhatIsAttachedStaysWithTheNextRobot) {
  const auto pixels = [&](std::int64_t stamp) {
    bench_.judge(stamp);
    return bench_.masked();
  };
  attach(live_part(start - seconds));  // before the robot is known
  bench_.tell_all();
  const auto with = pixels(start);
  bench_.tell_robot(live_urdf + std::string(" "));
  const auto with_next = pixels(start + image_period);
  attach(live_part(start + 40 * milliseconds, io::CollisionObjectMessage::remove));
  const auto without = pixels(start + 2 * image_period);
  EXPECT_EQ(bench_.status(), "ok");
  EXPECT_GT(with, without + part_pixels);
  EXPECT_GT(with_next, without + part_pixels);
}

/// Two robots: "a" is before the camera, "b" is far beside the image.
TEST(LiveRobots, HaveNamespacesAndFailAlone) {
  LiveBench bench(LiveBench::of_robots({"a", "b"}));
  LiveTruth truth;
  const auto fault = [&] { return bench.inbox.robot().fault(); };
  const auto make = [&] {
    bench.inbox.set_robot(io::make_robot(*bench.inbox.take_load_request()));
  };
  bench.publish("/a/robot_description", encoded(io::StringMessage{live_urdf}));
  EXPECT_FALSE(bench.inbox.take_load_request()) << "b is missing";
  bench.publish("/b/robot_description", encoded(io::StringMessage{live_urdf}));
  make();
  EXPECT_TRUE(holds(fault(), "'a/base'")) << "no mount yet";
  bench.publish("/tf_static",
                encoded(io::TfMessage{{{{0, "world"}, "a/base"}, {{0, "a/base"}, "optical"}}}));
  const auto half = bench.inbox.take_load_request();
  ASSERT_TRUE(half) << "as soon as a transform is new";
  bench.tell_transform("world", "b/base", 100.0);
  bench.inbox.set_robot(io::make_robot(*half));
  EXPECT_TRUE(holds(fault(), "'b/base'")) << "it came later";
  make();
  EXPECT_EQ(fault(), "");
  bench.tell_info(0);
  const std::vector<std::string> both{"/a", "/b"};
  const auto expect_status = [&](std::int64_t stamp, const std::vector<std::string>& robots,
                                 const std::string& status, std::int64_t waits = 0) {
    for (const std::string& robot : robots)
      bench.tell_joints_around(stamp, robot + "/joint_states");
    bench.tell_depth(stamp);
    bench.now += waits;
    EXPECT_EQ(bench.work(), 1U);
    EXPECT_EQ(bench.status(), status);
  };
  expect_status(start, both, "ok");

  // Both MoveIts attach an object called part; one removes all of its own.
  const auto attach = [&](const std::string& robot, const io::AttachedObjectMessage& part) {
    bench.publish(robot + "/attached_collision_object", encoded(part));
  };
  const auto pixels = [&](int ms) {
    expect_status(start + ms * milliseconds, both, "ok");
    return bench.masked();
  };
  io::AttachedObjectMessage none;
  none.object.header.stamp = start + 90 * milliseconds;
  none.object.operation = io::CollisionObjectMessage::remove;
  const auto bare = pixels(40);
  for (const std::string& robot : both) attach(robot, live_part(start + milliseconds));
  EXPECT_GT(pixels(80), bare + part_pixels);
  attach("/b", none);
  EXPECT_GT(pixels(120), bare + part_pixels) << "that of a stays";
  attach("/a", none);
  EXPECT_LT(pixels(160), bare + part_pixels);
  bench.results.published.clear();

  expect_status(start + seconds, {"/a"}, "missing_link", seconds);  // b is silent
  EXPECT_EQ(expect_true_labels(bench.results.published, truth), 1U);
  expect_status(start + 2 * seconds, {"/b"}, "stale_joints", seconds);  // a carries the camera
}

/// The messages' stamps are not those of their events: one was made earlier and sent again. See
/// LiveRobotsChaos, too.
TEST_F(LiveInboxTest, WhatIsDetachedAndAttachedWithOldStampsHoldsFromNowOn) {
  using Object = io::CollisionObjectMessage;
  bench_.tell_all();
  std::int64_t now = start;
  const auto next = [&] {
    bench_.judge(now += image_period);
    EXPECT_EQ(bench_.status(), "ok");
    return bench_.masked();
  };
  const auto bare = next();
  const auto expect_shown = [&](bool is_shown, const std::string& what) {
    EXPECT_EQ(next() > bare + part_pixels, is_shown) << what;
  };
  attach(live_part(now + milliseconds));
  expect_shown(true, "attached");
  attach(live_part(start - seconds, Object::remove, ""));  // all, before it was attached
  expect_shown(false, "detached");
  attach(live_part(start - 5 * milliseconds));  // before it was detached
  expect_shown(true, "attached again");
  attach(live_part(now + milliseconds, Object::remove));
  expect_shown(false, "detached again");
  // A scene that is late, as the answer to a question, says what was attached then.
  io::PlanningSceneMessage scene;
  scene.robot_state.joints.header.stamp = start;
  scene.robot_state.joints.names = {"spin"};
  scene.robot_state.attached = {live_part(start - 5 * milliseconds)};
  bench_.publish("/monitored_planning_scene", encoded(scene));
  expect_shown(false, "late scene");
}

TEST_F(LiveInboxTest, ImagesOfAnotherFrameThanTheirCameraInfoAreRefused) {
  bench_.tell_all();
  bench_.tell_joints_around(start);
  bench_.publish("/camera/depth/image_rect_raw", live_depth(start, "elsewhere"));
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_TRUE(holds(bench_.inbox.camera(0).setup_fault(), "elsewhere"));
  EXPECT_EQ(bench_.judge(start + image_period), 1U);
}

/// A camera that sends a camera_info with each image is replaced by another one, whose camera_info
/// arrives a second later than its images.
TEST_F(LiveInboxTest, NoImageIsJudgedByTheCameraInfoOfTheDriverBefore) {
  bench_.tell_all();
  const auto drive = [&](std::int64_t from, int images, double focal, std::uint64_t publisher) {
    std::size_t judged = 0;
    for (int i = 0; i < images; ++i) {
      const std::int64_t stamp = from + i * image_period;
      if (focal > 0)
        bench_.publish("/camera/depth/camera_info", encoded(live_info(stamp, {.focal = focal})),
                       publisher);
      bench_.tell_joints_around(stamp);
      bench_.publish("/camera/depth/image_rect_raw", live_depth(stamp), publisher);
      bench_.now += image_period;
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
  EXPECT_EQ(true_labels(), 3U);
}

TEST_F(LiveInboxTest, CameraInfosThatComeOnceOrSeldomHoldForAllImages) {
  bench_.tell_all();
  std::size_t judged = 0;
  for (int i = 0; i < 60; ++i) {
    const std::int64_t stamp = start + i * image_period;
    if (i % 30 == 10) bench_.tell_info(stamp);  // of an image's stamp, once a second
    bench_.tell_joints_around(stamp);
    bench_.tell_depth(stamp);
    bench_.now += image_period;
    judged += bench_.work();
  }
  bench_.now += 200 * milliseconds;
  judged += bench_.work();
  const io::ImageCounts counts = bench_.counts();
  EXPECT_EQ(counts.of(DropReason::no_camera_info), 0U);
  EXPECT_EQ(judged + counts.of(DropReason::superseded), 60U);
  EXPECT_GT(judged, 50U);
  EXPECT_EQ(true_labels(), judged);
}

/// Two boards side by side, "left" and "right", whose joint states come every 10 ms, 5 and 9 ms
/// after their stamps. Images come every 50 ms without delay.
class LateRobotsTest : public testing::Test {
 protected:
  LateRobotsTest() {
    bench_.tell_transform("world", "left/base", -0.5);
    bench_.tell_transform("world", "right/base", 0.5);
    bench_.tell_transform("world", "optical");
    bench_.tell_robots({"left", "right"});
    bench_.tell_info(0);
  }
  /// Plays a second. Returns how many of its 20 images had each status.
  std::map<std::string, std::size_t> play(bool with_right) {
    std::map<std::string, std::size_t> statuses;
    for (int ms = 0; ms < 1000; ++ms, bench_.now += milliseconds) {
      if (ms % 10 == 5)
        bench_.publish("/left/joint_states", live_joints(bench_.now - 5 * milliseconds));
      if (ms % 10 == 9 && with_right)
        bench_.publish("/right/joint_states", live_joints(bench_.now - 9 * milliseconds));
      if (ms % 50 == 0) bench_.tell_depth(bench_.now);
      if (bench_.work() == 0) continue;
      ++statuses[bench_.status()];
      delay_ = bench_.now - *bench_.job.stamp;
    }
    return statuses;
  }

  LiveBench bench_{LiveBench::of_robots({"left", "right"})};
  std::int64_t delay_ = 0;  // of the last image, in nanoseconds
};

TEST_F(LateRobotsTest, AreAwaitedUntilTheyAreSilent) {
  EXPECT_EQ(play(true), (std::map<std::string, std::size_t>{{"ok", 20}}));
  EXPECT_EQ(delay_, 9 * milliseconds);
  EXPECT_GE(play(false).at("missing_link"), 15U);
  EXPECT_LT(delay_, 10 * milliseconds);
  EXPECT_GE(play(true).at("ok"), 19U) << "the right one is back";
}

TEST_F(LateRobotsTest, ThatNeverCameDelayTheFirstImagesOnly) {
  EXPECT_GE(play(false).at("missing_link"), 15U);
  EXPECT_LT(delay_, 10 * milliseconds);
}

}  // namespace
}  // namespace penumbra::test
