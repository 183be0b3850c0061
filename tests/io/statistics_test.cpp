// SPDX-License-Identifier: Apache-2.0
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include <io/files/statistics.hpp>

namespace penumbra::io {
namespace {

TEST(Statistics, QuantilesByRank) {
  EXPECT_FALSE(quantiles({}).has_value());
  const auto one = quantiles({3.0}).value();
  EXPECT_EQ(one.min, 3.0);
  EXPECT_EQ(one.median, 3.0);
  EXPECT_EQ(one.p99, 3.0);
  EXPECT_EQ(one.max, 3.0);
  EXPECT_EQ(quantiles({4.0, 1.0, 2.0, 3.0})->median, 2.5);

  std::vector<double> samples(200);
  std::iota(samples.rbegin(), samples.rend(), 1.0);
  EXPECT_EQ(quantiles(samples)->p99, 198.0) << "198 of 200 are 99 %";
  EXPECT_EQ(quantiles(samples)->median, 100.5);
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
    report.message = "reason " + std::to_string(index);
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
  EXPECT_EQ(statistics.faults()[0].reasons[0].message, "reason 5");
  EXPECT_EQ(statistics.pixels().robot, 10U);
  EXPECT_EQ(statistics.pixels().unknown, 200U);
  EXPECT_EQ(statistics.timing(1)->max, 0.5);
  EXPECT_FALSE(statistics.timing(0).has_value());
}

TEST(Statistics, KeepsEveryReasonUpToABound) {
  Statistics statistics;
  FrameReport report;
  report.status = FrameStatus::bad_depth;
  for (const char* const message : {"truncated", "8 bits", "truncated"}) {
    report.message = message;
    statistics.add(report);
    ++report.index;
  }
  const Fault& fault = statistics.faults().at(0);
  ASSERT_EQ(fault.reasons.size(), 2U);
  EXPECT_EQ(fault.reasons[0].frames, 2U);
  EXPECT_EQ(fault.reasons[1].message, "8 bits");
  EXPECT_EQ(fault.reasons[1].first, 1U);
  EXPECT_EQ(fault.other_reasons, 0U);

  for (int i = 0; i < 100; ++i) {
    report.message = "reason " + std::to_string(i);
    statistics.add(report);
  }
  EXPECT_EQ(fault.reasons.size(), Fault::max_reasons);
  std::size_t told = 0;
  for (const Reason& reason : fault.reasons) told += reason.frames;
  EXPECT_EQ(told + fault.other_reasons, fault.frames);
  EXPECT_EQ(fault.frames, 103U);
}

TEST(Statistics, ReasonsThatDifferInTheirFileAreOne) {
  const auto reasons_of = [](const std::vector<std::string>& messages) {
    Statistics statistics;
    FrameReport report;
    report.status = FrameStatus::bad_depth;
    for (const std::string& message : messages) {
      report.message = message;
      statistics.add(report);
    }
    return statistics.faults().at(0).reasons;
  };
  const auto depth = reasons_of({"r/depth/9.png: has 64 x 48 pixels; the camera has 48 x 64",
                                 "r/depth/10.png: has 64 x 48 pixels; the camera has 48 x 64",
                                 "r/depth/11.png: has 65 x 48 pixels; the camera has 48 x 64"});
  ASSERT_EQ(depth.size(), 2U) << "another size is another reason";
  EXPECT_EQ(depth[0].frames, 2U);
  EXPECT_EQ(depth[0].message, "r/depth/9.png: has 64 x 48 pixels; the camera has 48 x 64");
  EXPECT_EQ(reasons_of({"joints.csv:9: frame 7: column 'a' is empty",
                        "joints.csv:10: frame 8: column 'a' is empty"})
                .size(),
            1U);
  EXPECT_EQ(reasons_of({"j.csv has no row for frame 9", "j.csv has no row for frame 10"}).size(),
            1U);
  EXPECT_EQ(reasons_of({"a/1.png: is no PNG", "a/1.jpg: is no PNG"}).size(), 2U);
  EXPECT_EQ(reasons_of({"a/1.png: is no PNG", "a/2.png: is no PNG at all"}).size(), 2U);
  EXPECT_EQ(reasons_of({"joint 'a1' is missing", "joint 'a2' is missing"}).size(), 2U);
}

}  // namespace
}  // namespace penumbra::io
