// SPDX-License-Identifier: Apache-2.0
// Targets and estimates in a link whose place in a frame is not known.
#include "../support/errors.hpp"
#include "targets_fixture.hpp"

#include <array>
#include <string>
#include <string_view>

namespace penumbra::test {
namespace {

class DoubtedTargetsTest : public TargetsTest {
 protected:
  DoubtedTargetsTest() : TargetsTest(0.5) {}

  const FrameReport& frame_at(std::int64_t stamp, bool is_doubted,
                              std::span<const Target> targets) {
    const LinkDoubts doubts = {plate_, "two put it elsewhere"};
    return pipeline_.process({.stamp = stamp,
                              .depth = depth_.view(),
                              .joints = positions_,
                              .targets = targets,
                              .doubts = is_doubted ? doubts : LinkDoubts{}});
  }
  /// Behind the plate, or before it.
  static Target point(const char* name, const LinkFrame& frame) {
    return {.name = name, .shape = PointTarget{.position = {0.0, 0.0, 0.3}, .frame = frame}};
  }
  static void expect_doubted(const TargetReport& report) {
    EXPECT_EQ(report.verdict, Verdict::unknown);
    EXPECT_FALSE(report.judgement);
    for (const char* const part : {"link 'plate'", "two put it elsewhere"})
      EXPECT_NE(report.reason.find(part), std::string_view::npos) << report.reason;
  }

  const std::array<std::size_t, 1> plate_ = {*slab_robot().find_link("plate")};
};

TEST_F(DoubtedTargetsTest, AreUnknownInThatLinkAlone) {
  const std::vector<Target> targets = {point("a", "plate"), point("b", "slab"), point("c", "base")};
  for (const bool is_doubted : {false, true}) {
    const FrameReport& report = frame_at(is_doubted ? 100 * ms : 0, is_doubted, targets);
    EXPECT_EQ(report.status, FrameStatus::ok);
    if (is_doubted)
      expect_doubted(report.targets[0]);
    else
      EXPECT_TRUE(report.targets[0].judgement) << report.targets[0].reason;
    for (const std::size_t other : {1U, 2U}) EXPECT_TRUE(report.targets[other].judgement) << other;
  }
}

TEST_F(DoubtedTargetsTest, AreUnknownOnAFrameThatIsKept) {
  frame_at(0, true, {});
  frame_at(100 * ms, false, {});
  for (const std::int64_t stamp : {std::int64_t{0}, 100 * ms}) {
    Target late = point(stamp == 0 ? "first" : "second", "plate");
    late.stamp = stamp;
    const TargetReport& report = frame_at(200 * ms, stamp != 0, {&late, 1}).targets[0];
    if (stamp == 0)
      expect_doubted(report);
    else
      EXPECT_TRUE(report.judgement) << report.reason;
  }
}

TEST_F(DoubtedTargetsTest, EstimatesInThatLinkAreRefused) {
  Target target = region("handled", beside_slab);
  target.handling = PointTrackerConfig{};
  target.estimate = TargetEstimate{.value = Eigen::Vector3d(0.1, 0.0, 0.2), .frame = "plate"};
  EXPECT_EQ(frame_at(0, true, {&target, 1}).targets[0].estimate, Outcome::refused_invalid);
  EXPECT_EQ(frame_at(100 * ms, false, {&target, 1}).targets[0].estimate, Outcome::accepted);
}

TEST_F(DoubtedTargetsTest, WhatIsNoLinkIsRefused) {
  const std::size_t count = slab_robot().links().size();
  const auto process = [&](std::size_t link) {
    const std::array links = {plate_[0], link};
    return pipeline_
        .process({.depth = depth_.view(), .joints = positions_, .doubts = {links, "no reason"}})
        .status;
  };
  EXPECT_EQ(process(count - 1), FrameStatus::ok);
  for (const std::size_t none : {count, std::size_t{1000000}}) {
    expect_refused([&] { process(none); }, {"doubted link " + std::to_string(none), "'slabs'"});
  }
  EXPECT_EQ(process(0), FrameStatus::ok);  // a good frame is judged after it
}

}  // namespace
}  // namespace penumbra::test
