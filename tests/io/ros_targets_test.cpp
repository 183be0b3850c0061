// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

TEST(RosTargets, AReportsTargetsArrive) {
  TargetReport part{}, lost{};
  part.name = "part";
  part.stamp = 77;
  part.judgement.emplace();
  part.judgement->covered = 200;
  part.judgement->inside = 100;
  part.judgement->occluded = 0.375;
  part.judgement->blame = {{2, 0.25, "tool"}, {1, 0.125, "wrist"}};
  part.point = Eigen::Vector3d(1, 2, 3);
  part.handled = HandledTarget{Source::held, 0.5, Eigen::Vector3d(4, 5, 6),
                               Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), 0.01};
  lost.name = "wrist";
  lost.reason = "not found";
  const std::vector<TargetReport> targets = {part, lost};
  FrameReport report;
  report.stamp = 123;
  report.status = FrameStatus::missing_depth;
  report.targets = targets;
  const TargetsMessage message = targets_message(report, "optical", "base");
  EXPECT_EQ(message.header.stamp, 123);
  EXPECT_EQ(message.header.frame_id, "optical");
  EXPECT_EQ(message.root_frame, "base");
  EXPECT_EQ(message.status, "missing_depth");
  ASSERT_EQ(message.targets.size(), 2U);
  const TargetMessage& told = message.targets[0];
  EXPECT_EQ(told.stamp, 77);
  EXPECT_EQ(told.covered, 200U);
  EXPECT_EQ(told.occluded_fraction, 0.375);
  ASSERT_EQ(told.blame.size(), 2U);
  EXPECT_EQ(told.blame[0].link, "tool");
  EXPECT_EQ(told.point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(told.pose.orientation, Eigen::Vector4d(0.5, -0.5, 0.5, 0.5));  // x, y, z, w
  const TargetMessage& second = message.targets[1];
  EXPECT_EQ(second.verdict, TargetMessage::unknown);
  EXPECT_EQ(second.reason, "not found");
  EXPECT_FALSE(second.has_stamp || second.judged);
  EXPECT_TRUE(second.point.array().isNaN().all());
}

/// The number of NaN among a target's numbers, without its pose.
int nans_of(const TargetMessage& m) {
  int nans = 0;
  for (const double number :
       {m.occluded_fraction, m.front_fraction, m.clear_fraction, m.unknown_fraction,
        m.hidden_by_other_fraction, m.measured_fraction, m.seen_past_fraction, m.point.x(),
        m.point.y(), m.point.z(), m.point_spread, m.age, m.sigma, m.forecast_seconds, m.hidden_in,
        m.hidden_for, m.lost_in})
    nans += std::isnan(number);
  return nans;
}

TEST(RosTargets, OnlyWhatIsNotKnownIsNaN) {
  TargetReport target{};
  FrameReport report;
  report.targets = std::span(&target, 1);
  const auto sent = [&] { return targets_message(report, "c", "r").targets[0]; };
  EXPECT_TRUE(std::isnan(sent().occluded_fraction)) << "0 would look visible";
  EXPECT_EQ(nans_of(sent()), 4 + 3 + 2);
  target.judgement.emplace();
  target.judgement->inside = target.judgement->covered = 100;
  EXPECT_EQ(nans_of(sent()), 3 + 2) << "the point and the forecast";
  target.point = Eigen::Vector3d(1, 2, 3);
  target.handled = HandledTarget{};
  target.forecast = {{.begin = 0, .end = 2, .verdict = Verdict::visible}};
  EXPECT_EQ(nans_of(sent()), 0);
  EXPECT_TRUE(std::isnan(sent().pose.position.x())) << "it is lost";
}

TEST(RosTargets, EachValueHasItsOwn) {
  using T = TargetMessage;
  TargetReport target{};
  target.name = "t";
  FrameReport report;
  report.targets = std::span(&target, 1);
  const auto sent = [&] { return targets_message(report, "c", "r").targets[0]; };
  for (const auto& [verdict, value] : {std::pair(Verdict::visible, T::visible),
                                       {Verdict::partial, T::partial},
                                       {Verdict::hidden, T::hidden},
                                       {Verdict::unknown, T::unknown},
                                       {Verdict::out_of_view, T::out_of_view},
                                       {Verdict::held, T::held_by_link}}) {
    target.verdict = verdict;
    EXPECT_EQ(sent().verdict, value);
    EXPECT_EQ(sent().verdict_name, to_string(verdict));
  }
  target.handled = HandledTarget{};
  for (const auto& [source, value] : {std::pair(Source::measured, T::measured),
                                      {Source::predicted, T::predicted},
                                      {Source::held, T::held},
                                      {Source::lost, T::lost}}) {
    target.handled->source = source;
    EXPECT_EQ(sent().source, value);
  }
  for (const auto& [outcome, value] : {std::pair(Outcome::accepted, T::accepted),
                                       {Outcome::refused_verdict, T::refused_verdict},
                                       {Outcome::refused_gate, T::refused_gate},
                                       {Outcome::refused_late, T::refused_late},
                                       {Outcome::refused_invalid, T::refused_invalid}}) {
    target.estimate = outcome;
    EXPECT_EQ(sent().estimate, value);
  }
}

}  // namespace
}  // namespace penumbra::io
