// SPDX-License-Identifier: Apache-2.0
// Several robots whose joint states come after the image.
#include "live_scene.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

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

  using Statuses = std::map<std::string, std::size_t>;
  LiveBench bench_{LiveBench::of_robots({"left", "right"})};
  std::int64_t delay_ = 0;  // of the last image, in nanoseconds
};

TEST_F(LateRobotsTest, AreAwaited) {
  EXPECT_EQ(play(true), (Statuses{{"ok", 20}}));
  EXPECT_EQ(delay_, 9 * milliseconds);
}

TEST_F(LateRobotsTest, AreNotAwaitedAnyMoreOnceTheyAreSilent) {
  play(true);
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
