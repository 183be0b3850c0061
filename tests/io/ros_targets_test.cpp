// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

Judgement judged_partial(std::span<const Blame> blame) {
  Judgement judged;
  judged.covered = 200;
  judged.inside = 100;
  judged.occluded = 0.375;
  judged.front = 0.125;
  judged.unknown = 0.25;
  judged.clear = 0.25;
  judged.measured = 0.75;
  judged.seen_past = 0.0625;
  judged.blame = blame;
  judged.point_pixels = 9;
  judged.point_spread = 0.002;
  return judged;
}

/// A target with all that a report may tell of it.
TargetReport full_report(std::span<const Blame> blame) {
  TargetReport target{};
  target.name = "part";
  target.stamp = 77;
  target.verdict = Verdict::partial;
  target.judgement = judged_partial(blame);
  target.point = Eigen::Vector3d(1, 2, 3);
  target.handled = HandledTarget{Source::held, 0.5, Eigen::Vector3d(4, 5, 6),
                                 Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), 0.01};
  target.estimate = Outcome::refused_late;
  return target;
}

void expect_full_report(const TargetMessage& target) {
  EXPECT_EQ(target.name, "part");
  EXPECT_TRUE(target.has_stamp);
  EXPECT_EQ(target.stamp, 77);
  EXPECT_EQ(target.verdict, TargetMessage::partial);
  EXPECT_TRUE(target.judged);
  EXPECT_EQ(target.covered, 200U);
  EXPECT_EQ(target.inside, 100U);
  EXPECT_EQ(target.occluded_fraction, 0.375);
  EXPECT_TRUE(std::isnan(target.hidden_by_other_fraction));
  EXPECT_EQ(target.measured_fraction, 0.75);
  EXPECT_EQ(target.seen_past_fraction, 0.0625);
  ASSERT_EQ(target.blame.size(), 2U);
  EXPECT_EQ(target.blame[0].link, "tool");
  EXPECT_EQ(target.blame[1].fraction, 0.125);
  EXPECT_EQ(target.point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(target.point_pixels, 9U);
  EXPECT_EQ(target.source, TargetMessage::held);
  EXPECT_EQ(target.pose.orientation, Eigen::Vector4d(0.5, -0.5, 0.5, 0.5));  // x, y, z, w
  EXPECT_EQ(target.estimate, TargetMessage::refused_late);
}

TEST(RosTargets, AReportsTargetsArrive) {
  const std::vector<std::string> links = {"base", "arm", "tool"};
  const std::vector<Blame> blame = {{2, 0.25}, {1, 0.125}};
  TargetReport lost{};
  lost.name = "wrist";
  lost.reason = "not found";
  const std::vector<TargetReport> targets = {full_report(blame), lost};
  FrameReport report;
  report.stamp = 123;
  report.status = FrameStatus::missing_depth;
  report.message = "no depth image";
  report.targets = targets;
  report.links = links;

  const TargetsMessage message = targets_message(report, "optical", "base");
  EXPECT_EQ(message.header.stamp, 123);
  EXPECT_EQ(message.header.frame_id, "optical");
  EXPECT_EQ(message.root_frame, "base");
  EXPECT_EQ(message.status, "missing_depth");
  EXPECT_EQ(message.message, "no depth image");
  ASSERT_EQ(message.targets.size(), 2U);
  expect_full_report(message.targets[0]);
  const TargetMessage& second = message.targets[1];
  EXPECT_EQ(second.verdict, TargetMessage::unknown);
  EXPECT_EQ(second.reason, "not found");
  EXPECT_FALSE(second.has_stamp);
  EXPECT_FALSE(second.judged);
  EXPECT_TRUE(second.point.array().isNaN().all());
  EXPECT_EQ(second.source, TargetMessage::not_handled);
  EXPECT_EQ(second.estimate, TargetMessage::no_estimate);
}

TEST(RosTargets, EachValueHasItsOwn) {
  TargetReport target{};
  target.name = "t";
  FrameReport report;
  const auto sent = [&] {
    report.targets = std::span(&target, 1);
    return targets_message(report, "c", "r").targets[0];
  };
  const std::vector<std::pair<Verdict, int>> verdicts = {
      {Verdict::visible, TargetMessage::visible},
      {Verdict::partial, TargetMessage::partial},
      {Verdict::hidden, TargetMessage::hidden},
      {Verdict::unknown, TargetMessage::unknown},
      {Verdict::out_of_view, TargetMessage::out_of_view}};
  for (const auto& [verdict, value] : verdicts) {
    target.verdict = verdict;
    EXPECT_EQ(sent().verdict, value);
  }
  const std::vector<std::pair<Source, int>> sources = {
      {Source::measured, TargetMessage::measured},
      {Source::predicted, TargetMessage::predicted},
      {Source::held, TargetMessage::held},
      {Source::lost, TargetMessage::lost}};
  for (const auto& [source, value] : sources) {
    target.handled = HandledTarget{};
    target.handled->source = source;
    EXPECT_EQ(sent().source, value);
  }
  const std::vector<std::pair<Outcome, int>> outcomes = {
      {Outcome::accepted, TargetMessage::accepted},
      {Outcome::refused_verdict, TargetMessage::refused_verdict},
      {Outcome::refused_gate, TargetMessage::refused_gate},
      {Outcome::refused_late, TargetMessage::refused_late},
      {Outcome::refused_invalid, TargetMessage::refused_invalid}};
  for (const auto& [outcome, value] : outcomes) {
    target.estimate = outcome;
    EXPECT_EQ(sent().estimate, value);
  }
}

}  // namespace
}  // namespace penumbra::io
