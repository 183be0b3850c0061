// SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include <gtest/gtest.h>

#include <io/files/statistics.hpp>

namespace penumbra::io {
namespace {

TEST(Statistics, QuantilesByRank) {
  EXPECT_FALSE(quantiles({}).has_value());
  EXPECT_EQ(quantiles({3.0})->p99, 3.0);
  EXPECT_EQ(quantiles({4.0, 1.0, 2.0, 3.0})->median, 3.0);

  std::vector<double> samples(200);
  std::iota(samples.rbegin(), samples.rend(), 1.0);
  EXPECT_EQ(quantiles(samples)->p99, 198.0) << "198 of 200 are 99 %";
  EXPECT_EQ(quantiles(samples)->median, 101.0);
  EXPECT_EQ(quantiles(samples)->max, 200.0);
}

TEST(Statistics, CountsFaultsByKind) {
  Statistics statistics;
  FrameReport report;
  report.pixels.robot = 10;
  report.pixels.front = 3;
  report.timing.render = 0.5;
  statistics.add(report);
  for (const std::size_t index : {5U, 6U}) {
    report = {};
    report.index = index;
    report.status = FrameStatus::missing_joints;
    report.message = (index == 5 ? "reason a " : "reason b ") + std::to_string(index);
    report.pixels.unknown = 100;
    statistics.add(report);
  }
  EXPECT_EQ(statistics.frames(), 3U);
  EXPECT_EQ(statistics.bad_frames(), 2U);
  EXPECT_EQ(statistics.usable_frames(), 1U);
  ASSERT_EQ(statistics.faults().size(), 1U);
  EXPECT_EQ(statistics.faults()[0].frames, 2U);
  ASSERT_EQ(statistics.faults()[0].reasons.size(), 2U);
  EXPECT_EQ(statistics.faults()[0].reasons[0].first, 5U);
  EXPECT_EQ(statistics.faults()[0].reasons[0].message, "reason a 5");
  EXPECT_EQ(statistics.pixels().robot, 10U);
  EXPECT_EQ(statistics.pixels().unknown, 200U);
  EXPECT_EQ(statistics.timing(1)->max, 0.5);
  EXPECT_FALSE(statistics.timing(0).has_value());
}

}  // namespace
}  // namespace penumbra::io
