// SPDX-License-Identifier: Apache-2.0
// A live inbox that is told messages by hand.
#pragma once

#include "live_scene.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {

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

}  // namespace penumbra::test
