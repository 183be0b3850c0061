// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra::test {
namespace {

/// Joint states and images are told by the milliseconds of their stamps.
class QueueTest : public testing::Test {
 protected:
  FrameQueue& make(const FrameQueueOptions& options) {
    return queue_.emplace(robot_, history_, options);
  }

  void joint(std::int64_t stamp_ms) {
    const std::string names[] = {"slide"};
    const double positions[] = {double(stamp_ms) * 1e-3};
    history_.add_joints(stamp_ms * ms, names, positions);
  }

  void image(std::int64_t stamp_ms, std::int64_t now_ms) {
    queue_->push({.stamp = stamp_ms * ms}, now_ms * ms);
  }

  /// The stamp of what comes out; -1: nothing.
  std::int64_t next(std::int64_t now_ms) {
    frame_ = queue_->next(now_ms * ms);
    return frame_ ? *frame_->stamp / ms : -1;
  }

  Robot robot_ = slab_robot();
  PoseHistory history_{robot_, {.joints = {.max_gap = 0.1}}};
  std::optional<FrameQueue> queue_;
  std::shared_ptr<Frame> frame_;
};

TEST_F(QueueTest, TwoCamerasShareAHistory) {
  make({.policy = DropPolicy::newest});
  std::vector<DropReason> dropped;
  FrameQueue other(robot_, history_, {.policy = DropPolicy::every},
                   [&](const auto&, DropReason reason) { dropped.push_back(reason); });
  joint(5000);
  image(5010, 5015);
  other.push({.stamp = 5010 * ms}, 5015 * ms);
  image(1000, 5020);  // this camera's clock jumps back
  EXPECT_FALSE(other.next(5021 * ms));
  EXPECT_EQ(dropped, std::vector{DropReason::clock_jump});
  other.push({.stamp = 1000 * ms}, 5022 * ms);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  joint(1000);
  EXPECT_TRUE(other.next(5023 * ms));
  EXPECT_EQ(next(5023), 1000);
}

TEST_F(QueueTest, AJumpKeepsFramesThatAwaitOnlyTheirCompanions) {
  bool are_there = false;
  std::vector<DropReason> dropped;
  queue_.emplace(
      robot_, history_, FrameQueueOptions{.policy = DropPolicy::every, .companion_wait = 1.0},
      [&](const auto&, DropReason reason) { dropped.push_back(reason); },
      [&](const Frame&, bool over) {
        return are_there || over ? Companions::complete : Companions::awaited;
      });
  for (const std::int64_t stamp : {5000, 5050, 5100}) {
    joint(stamp);
    image(stamp, stamp);
    EXPECT_EQ(next(stamp), -1);
  }
  image(5150, 5150);  // its joint state has not come
  EXPECT_EQ(next(5150), -1);
  EXPECT_EQ(queue_->wake_at(), 5350 * ms);
  joint(1000);  // the clock is set back
  EXPECT_EQ(next(5160), -1);
  EXPECT_EQ(dropped, std::vector{DropReason::clock_jump});
  are_there = true;
  for (const std::int64_t stamp : {5000, 5050, 5100}) {
    ASSERT_EQ(next(5170), stamp);
    EXPECT_EQ(frame_->pose.status, FrameStatus::ok) << frame_->pose.message;
  }
}

TEST_F(QueueTest, AFrameWithoutItsCompanionsIsDroppedOrGivenInTime) {
  std::vector<DropReason> dropped;
  queue_.emplace(
      robot_, history_, FrameQueueOptions{.policy = DropPolicy::newest, .companion_wait = 0.1},
      [&](const auto&, DropReason reason) { dropped.push_back(reason); },
      [&](const Frame& frame, bool over) {
        return !over                       ? Companions::awaited
               : *frame.stamp == 5000 * ms ? Companions::missing
                                           : Companions::complete;
      });
  for (const std::int64_t stamp : {5000, 5050}) {
    joint(stamp);
    image(stamp, stamp);
  }
  EXPECT_EQ(next(5050), -1);
  EXPECT_EQ(next(5100), -1);
  EXPECT_EQ(dropped, std::vector{DropReason::no_camera_info});
  EXPECT_EQ(next(5149), -1);
  EXPECT_EQ(next(5150), 5050);
}

TEST_F(QueueTest, RefusesFaultyOptions) {
  const auto refused = [&](const FrameQueueOptions& options, std::string_view part) {
    expect_refused([&] { make(options); }, {part});
  };
  refused({.time_offset = nan}, "time_offset");
  refused({.time_offset = -2e9}, "time_offset");
  refused({.max_wait = -0.1}, "max_wait");
  refused({.companion_wait = -0.1}, "companion_wait");
  refused({.max_frames = 0}, "max_frames");
  refused({.poses = {.camera_parent = "nowhere"}}, "nowhere");
}

}  // namespace
}  // namespace penumbra::test
