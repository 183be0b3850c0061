// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra::test {
namespace {

/// Joint states and images are told by the milliseconds of their stamps.
class QueueTest : public testing::Test {
 protected:
  FrameQueue& make(const FrameQueueOptions& options) {
    queue_.emplace(robot_, history_, options,
                   [this](const DroppedFrame& frame) { dropped_.push_back(frame); });
    return *queue_;
  }
  FrameQueue& make(DropPolicy policy) { return make({.policy = policy}); }

  void joint(std::int64_t stamp_ms) {
    const std::string names[] = {"slide"};
    const double positions[] = {static_cast<double>(stamp_ms) * 1e-3};
    history_.add_joints(stamp_ms * ms, names, positions);
  }

  /// The image's key is its stamp.
  void image(std::int64_t stamp_ms, std::int64_t now_ms) {
    queue_->push(static_cast<std::uint64_t>(stamp_ms), stamp_ms * ms, now_ms * ms);
  }

  /// The stamp of what comes out; -1: nothing.
  std::int64_t next(std::int64_t now_ms) {
    if (!queue_->next(now_ms * ms, frame_)) return -1;
    EXPECT_EQ(frame_.key * static_cast<std::uint64_t>(ms),
              static_cast<std::uint64_t>(frame_.stamp));
    return frame_.stamp / ms;
  }

  void expect_dropped(const std::vector<std::int64_t>& stamps_ms, DropReason reason) {
    std::vector<std::int64_t> seen;
    for (const DroppedFrame& frame : dropped_) {
      EXPECT_EQ(frame.reason, reason);
      seen.push_back(frame.stamp / ms);
    }
    EXPECT_EQ(seen, stamps_ms);
    dropped_.clear();
  }

  Robot robot_ = slab_robot();
  PoseHistory history_{robot_, {.joints = {.max_gap = 0.1}}};
  std::optional<FrameQueue> queue_;
  std::vector<DroppedFrame> dropped_;
  QueuedFrame frame_;
};

class EveryPolicy : public QueueTest, public testing::WithParamInterface<DropPolicy> {};
INSTANTIATE_TEST_SUITE_P(Policies, EveryPolicy,
                         testing::Values(DropPolicy::newest, DropPolicy::every),
                         [](const auto& test) {
                           return test.param == DropPolicy::newest ? "Newest" : "Every";
                         });

TEST_P(EveryPolicy, WaitsForTheStatesAroundTheStamp) {
  make(GetParam());
  joint(990);
  image(1000, 1005);
  EXPECT_EQ(next(1005), -1);
  joint(999);
  EXPECT_EQ(next(1010), -1) << "the latest state is not taken";
  EXPECT_EQ(queue_->wake_at(), 1205 * ms);
  joint(1009);
  ASSERT_EQ(next(1011), 1000);
  EXPECT_EQ(frame_.pose.status, FrameStatus::ok);
  EXPECT_NEAR(frame_.pose.joints.positions[0], 1.0, 1e-12);
  EXPECT_EQ(frame_.pose.age, 9 * ms);
  EXPECT_EQ(frame_.waited, 6 * ms);
  EXPECT_EQ(next(1011), -1);
  EXPECT_FALSE(queue_->wake_at());
  EXPECT_EQ(queue_->counts().given_out, 1U);
  EXPECT_EQ(queue_->counts().waiting, 0U);
}

TEST_P(EveryPolicy, StatesMayComeFirst) {
  make(GetParam());
  for (const int stamp : {990, 999, 1009, 1020, 1030}) joint(stamp);
  image(1000, 1035);
  ASSERT_EQ(next(1035), 1000);
  EXPECT_NEAR(frame_.pose.joints.positions[0], 1.0, 1e-12) << "not the latest";
  EXPECT_EQ(frame_.waited, 0);
}

TEST_P(EveryPolicy, GivesUpInTime) {
  make({.policy = GetParam(), .max_wait = 0.05});
  image(1000, 1005);
  joint(900);
  EXPECT_EQ(next(1054), -1);
  ASSERT_EQ(next(1055), 1000);
  EXPECT_EQ(frame_.pose.status, FrameStatus::stale_joints);
  EXPECT_NE(frame_.pose.message.find("'slide'"), std::string::npos);
  EXPECT_EQ(frame_.waited, 50 * ms);
  EXPECT_EQ(queue_->counts().without_pose, 1U);
  EXPECT_TRUE(dropped_.empty());
}

TEST_P(EveryPolicy, MayDropWhatHasNoPose) {
  make({.policy = GetParam(), .max_wait = 0.05, .drop_without_pose = true});
  image(1000, 1005);
  image(1030, 1035);
  joint(1025);
  joint(1035);
  EXPECT_EQ(next(1060), 1030);
  expect_dropped({1000},
                 GetParam() == DropPolicy::every ? DropReason::no_pose : DropReason::superseded);
  image(1060, 1065);
  EXPECT_EQ(next(1200), -1);
  expect_dropped({1060}, DropReason::no_pose);
}

TEST_P(EveryPolicy, AnOffsetMovesThePoseNotTheStamp) {
  make({.policy = GetParam(), .time_offset = -0.02});
  for (const int stamp : {970, 985, 990}) joint(stamp);
  image(1000, 1005);
  ASSERT_EQ(next(1005), 1000);
  EXPECT_EQ(frame_.pose_stamp, 980 * ms);
  EXPECT_NEAR(frame_.pose.joints.positions[0], 0.98, 1e-12);
  EXPECT_EQ(frame_.frame().stamp, 1000 * ms);
}

TEST_P(EveryPolicy, AJumpOfTheImagesClockDropsWhatWasBefore) {
  make(GetParam());
  joint(4900);
  joint(4910);
  image(5020, 5025);
  image(5050, 5055);
  joint(3990);  // late, and of the old time: it must not bracket what comes
  image(4005, 5060);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  EXPECT_NE(history_.last_jump().find("depth images"), std::string::npos);
  expect_dropped({5020, 5050}, DropReason::clock_jump);
  joint(4010);
  EXPECT_EQ(next(5061), -1) << "the state before it was of the old time";
  joint(4001);
  EXPECT_EQ(next(5062), 4005);
}

TEST_P(EveryPolicy, AJumpOfTheJointsClockDropsWhatWasBefore) {
  make(GetParam());
  joint(5000);
  image(5005, 5006);
  joint(3000);
  EXPECT_EQ(next(5007), -1);
  expect_dropped({5005}, DropReason::clock_jump);
  image(3005, 5010);
  joint(3008);
  EXPECT_EQ(next(5011), 3005);
  EXPECT_EQ(history_.clock_jumps(), 1U) << "one jump is one, whoever shows it";
}

TEST_P(EveryPolicy, AStampOfZeroIsNone) {
  make(GetParam());
  joint(1);
  image(0, 10);
  image(-1000, 10);
  EXPECT_EQ(next(500), -1);
  expect_dropped({0, -1000}, DropReason::no_stamp);
  EXPECT_EQ(history_.clock_jumps(), 0U);
}

TEST_P(EveryPolicy, NothingWaitsOnceAllIsThere) {
  make(GetParam());
  joint(1000);
  image(1000, 1001);
  image(1030, 1031);
  queue_->finish();
  if (GetParam() == DropPolicy::every) {
    EXPECT_EQ(next(1031), 1000);
    EXPECT_EQ(frame_.pose.status, FrameStatus::ok);
  }
  EXPECT_EQ(next(1031), 1030);
  EXPECT_EQ(frame_.pose.status, FrameStatus::stale_joints);
  EXPECT_EQ(next(1031), -1);
}

TEST_P(EveryPolicy, WaitsStartAgainWhenTheCallersClockGoesBack) {
  make({.policy = GetParam(), .max_wait = 0.05});
  image(1000, 9000);
  EXPECT_EQ(next(1000), -1);
  EXPECT_EQ(next(1049), -1);
  EXPECT_EQ(next(1050), 1000);
}

TEST_P(EveryPolicy, DisagreementIsKnownAtOnce) {
  make({.policy = GetParam(), .poses = {.source = PoseSource::both}});
  joint(1000);
  history_.add_transform(1000 * ms, "base", "slab", Eigen::Isometry3d::Identity());
  image(1000, 1001);
  ASSERT_EQ(next(1001), 1000);
  EXPECT_EQ(frame_.pose.status, FrameStatus::poses_disagree);
  const Frame frame = frame_.frame();
  EXPECT_EQ(frame.source_status, FrameStatus::poses_disagree);
  EXPECT_TRUE(frame.joints.positions.empty());
  EXPECT_TRUE(frame.T_root_link.empty());
}

class NewestQueue : public QueueTest {};

TEST_F(NewestQueue, GivesTheNewestThatCanBe) {
  make(DropPolicy::newest);
  for (const int stamp : {1000, 1030, 1060, 1090}) image(stamp, stamp + 5);
  for (const int stamp : {995, 1025, 1055, 1075}) joint(stamp);
  EXPECT_EQ(next(1096), 1060);
  expect_dropped({1000, 1030}, DropReason::superseded);
  joint(1095);
  EXPECT_EQ(next(1097), 1090);
  expect_dropped({}, DropReason::superseded);
}

TEST_F(NewestQueue, WhatComesAfterANewerOneIsLate) {
  make(DropPolicy::newest);
  joint(1000);
  joint(1050);
  image(1040, 1050);
  image(1030, 1051);
  EXPECT_EQ(next(1051), 1040);
  expect_dropped({1030}, DropReason::superseded);
  image(1040, 1052);
  image(1039, 1052);
  expect_dropped({1040, 1039}, DropReason::late);
  image(1041, 1053);
  EXPECT_EQ(next(1053), 1041);
}

TEST_F(NewestQueue, TheOldestGoesWhereTooManyWait) {
  make({.policy = DropPolicy::newest, .max_frames = 2});
  for (const int stamp : {1000, 1060, 1030}) image(stamp, stamp + 5);
  expect_dropped({1000}, DropReason::overflow);
  image(1010, 1065);
  expect_dropped({1010}, DropReason::overflow);
  EXPECT_EQ(queue_->counts().waiting, 2U);
  EXPECT_EQ(queue_->counts().of(DropReason::overflow), 2U);
}

class EveryQueue : public QueueTest {};

TEST_F(EveryQueue, KeepsTheOrderInWhichTheyCame) {
  make(DropPolicy::every);
  for (const int stamp : {1000, 1060, 1030}) image(stamp, stamp + 5);
  for (const int stamp : {1020, 1055, 1075}) joint(stamp);
  EXPECT_EQ(next(1076), -1) << "the first one still waits";
  joint(990);
  EXPECT_EQ(next(1077), 1000);
  EXPECT_EQ(next(1077), 1060);
  EXPECT_EQ(next(1077), 1030);
  EXPECT_TRUE(dropped_.empty());
}

TEST_F(EveryQueue, AFullOneWaitsNoLongerAndThenTakesNoMore) {
  make({.policy = DropPolicy::every, .max_frames = 2});
  image(1000, 1001);
  EXPECT_EQ(next(1001), -1);
  image(1030, 1031);
  image(1060, 1061);
  expect_dropped({1060}, DropReason::overflow);
  EXPECT_EQ(next(1061), 1000);
  EXPECT_EQ(frame_.pose.status, FrameStatus::missing_joints);
  EXPECT_EQ(next(1061), -1);
}

TEST_F(QueueTest, TwoCamerasShareAHistory) {
  make(DropPolicy::newest);
  FrameQueue other(robot_, history_, {.policy = DropPolicy::every});
  joint(5000);
  image(5010, 5015);
  other.push(77, 5010 * ms, 5015 * ms);
  image(1000, 5020);  // this camera's clock jumps back
  QueuedFrame frame;
  EXPECT_FALSE(other.next(5021 * ms, frame));
  EXPECT_EQ(other.counts().of(DropReason::clock_jump), 1U);
  other.push(78, 1000 * ms, 5022 * ms);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  joint(1000);
  EXPECT_TRUE(other.next(5023 * ms, frame));
  EXPECT_EQ(next(5023), 1000);
}

TEST_F(QueueTest, RefusesFaultyOptions) {
  const auto refused = [&](const FrameQueueOptions& options, const std::string& names) {
    try {
      make(options);
      ADD_FAILURE() << "accepted: " << names;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(names), std::string::npos) << error.what();
    }
  };
  refused({.time_offset = std::nan("")}, "time_offset");
  refused({.time_offset = -2e9}, "time_offset");
  refused({.max_wait = -0.1}, "max_wait");
  refused({.max_frames = 0}, "max_frames");
  refused({.poses = {.camera_parent = "nowhere"}}, "nowhere");
}

TEST_F(QueueTest, ReasonsHaveNames) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < drop_reasons; ++i)
    names.push_back(to_string(static_cast<DropReason>(i)));
  EXPECT_EQ(names, (std::vector<std::string_view>{"superseded", "late", "overflow", "clock_jump",
                                                  "no_stamp", "no_pose"}));
}

}  // namespace
}  // namespace penumbra::test
