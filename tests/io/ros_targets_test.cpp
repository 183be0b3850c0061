// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

TEST(RosTargets, AReportsTargetsArrive) {
  const std::vector<std::string> links = {"base", "arm", "tool"};
  const std::vector<Blame> blame = {{2, 0.25}, {1, 0.125}};
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
  TargetReport part{};
  part.name = "part";
  part.stamp = 77;
  part.verdict = Verdict::partial;
  part.judgement = judged;
  part.point = Eigen::Vector3d(1, 2, 3);
  part.handled = HandledTarget{Source::held, 0.5, Eigen::Vector3d(4, 5, 6),
                               Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), 0.01};
  part.estimate = Outcome::refused_late;
  TargetReport lost{};
  lost.name = "wrist";
  lost.reason = "not found";
  const std::vector<TargetReport> targets = {part, lost};
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
  const TargetMessage& first = message.targets[0];
  EXPECT_EQ(first.name, "part");
  EXPECT_TRUE(first.has_stamp);
  EXPECT_EQ(first.stamp, 77);
  EXPECT_EQ(first.verdict, TargetMessage::partial);
  EXPECT_TRUE(first.judged);
  EXPECT_EQ(first.covered, 200U);
  EXPECT_EQ(first.inside, 100U);
  EXPECT_EQ(first.occluded_fraction, 0.375);
  EXPECT_TRUE(std::isnan(first.hidden_by_other_fraction));
  EXPECT_EQ(first.measured_fraction, 0.75);
  EXPECT_EQ(first.seen_past_fraction, 0.0625);
  ASSERT_EQ(first.blame.size(), 2U);
  EXPECT_EQ(first.blame[0].link, "tool");
  EXPECT_EQ(first.blame[1].fraction, 0.125);
  EXPECT_EQ(first.point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(first.point_pixels, 9U);
  EXPECT_EQ(first.source, TargetMessage::held);
  EXPECT_EQ(first.pose.orientation, Eigen::Vector4d(0.5, -0.5, 0.5, 0.5));  // x, y, z, w
  EXPECT_EQ(first.estimate, TargetMessage::refused_late);
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
