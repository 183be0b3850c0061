// SPDX-License-Identifier: Apache-2.0
// Targets and estimates in a link whose place in a frame is not known.
#include "../support/errors.hpp"
#include "targets_fixture.hpp"

#include <array>
#include <string>
#include <string_view>

namespace penumbra::test {
namespace {

class UncertainLinksTest : public TargetsTest {
 protected:
  UncertainLinksTest() : TargetsTest(0.5) {}

  const FrameReport& frame_at(std::int64_t stamp, bool is_uncertain, std::vector<Target> targets) {
    Frame frame{.stamp = stamp,
                .depth = depth_.view(),
                .pose = {.positions = positions_},
                .targets = targets};
    if (is_uncertain) frame.pose.uncertain_links = plate_;
    frame.pose.uncertain_reason = "two publishers differ";
    return pipeline_.process(frame);
  }
  /// Behind the plate, or before it.
  static Target point(const char* name, const std::string& link) {
    return {
        .name = name,
        .shape = PointTarget{.position = {0.0, 0.0, 0.3}, .frame = ReferenceFrame::of_link(link)}};
  }
  static void expect_unknown(const TargetReport& report) {
    EXPECT_EQ(report.verdict, Verdict::unknown);
    EXPECT_FALSE(report.judgement);
    for (const char* const part : {"link 'plate'", "two publishers differ"})
      EXPECT_NE(report.reason.find(part), std::string_view::npos) << report.reason;
  }

  const std::vector<std::size_t> plate_ = {*slab_robot().find_link("plate")};
};

TEST_F(UncertainLinksTest, AreUnknownInThatLinkAlone) {
  const std::vector<Target> targets = {point("a", "plate"), point("b", "slab"), point("c", "base")};
  for (const bool is_uncertain : {false, true}) {
    const FrameReport& report = frame_at(is_uncertain ? 100 * ms : 0, is_uncertain, targets);
    EXPECT_EQ(report.status, is_uncertain ? FrameStatus::missing_link : FrameStatus::ok);
    if (is_uncertain)
      expect_unknown(report.targets[0]);
    else
      EXPECT_TRUE(report.targets[0].judgement) << report.targets[0].reason;
    for (const std::size_t other : {1U, 2U}) EXPECT_TRUE(report.targets[other].judgement) << other;
  }
}

TEST_F(UncertainLinksTest, WhatIsNoLinkIsRefused) {
  const std::size_t count = slab_robot().links().size();
  const auto process = [&](std::size_t link) {
    const std::vector<std::size_t> links = {plate_[0], link};
    return pipeline_
        .process(
            {.depth = depth_.view(), .pose = {.positions = positions_, .uncertain_links = links}})
        .status;
  };
  EXPECT_EQ(process(plate_[0]), FrameStatus::missing_link);
  for (const std::size_t none : {count, std::size_t{1000000}}) {
    expect_refused([&] { process(none); }, {std::to_string(none), "'slabs'"});
  }
  EXPECT_EQ(process(0), FrameStatus::missing_transform) << "the camera is in the root";
}

}  // namespace
}  // namespace penumbra::test
