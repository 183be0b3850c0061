// SPDX-License-Identifier: Apache-2.0
// What messages say of targets, and what becomes of messages of targets.
#include "../support/test.hpp"
#include "robots.hpp"

#include <io/ros/message_definition.hpp>
#include <io/ros/target_inbox.hpp>
#include <io/ros/target_messages.hpp>

namespace penumbra::io {
namespace {

TargetMessage sent_of(const TargetReport& target) {
  FrameReport report;
  report.targets = std::span(&target, 1);
  return targets_message(report, "optical", "base").targets.at(0);
}

TEST(RosTargets, WhatIsKnownOfATargetArrives) {
  TargetReport part{};
  part.judgement.emplace();
  part.judgement->covered = 200;
  part.judgement->inside = 100;
  part.judgement->occluded = 0.375;
  part.judgement->blame = {{2, 0.25, "tool"}, {1, 0.125, "wrist"}};
  part.point = Eigen::Vector3d(1, 2, 3);
  part.handled = HandledTarget{Source::held, 0.5, Eigen::Vector3d(4, 5, 6),
                               Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), 0.01};
  const TargetMessage told = sent_of(part);
  EXPECT_EQ(told.covered, 200U);
  EXPECT_EQ(told.occluded_fraction, 0.375);
  ASSERT_EQ(told.blame.size(), 2U);
  EXPECT_EQ(told.blame[0].link, "tool");
  EXPECT_EQ(told.point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(told.pose.orientation, Eigen::Vector4d(0.5, -0.5, 0.5, 0.5));  // x, y, z, w
  EXPECT_FALSE(told.has_stamp);
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
  const auto sent = [&] { return sent_of(target); };
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

TEST(RosTargets, EachValueIsAConstantOfTheDefinition) {
  const std::string definition(definition_of("penumbra_msgs/Target"));
  const auto expect_constant = [&](std::string name, int value) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_TRUE(test::holds(definition, "\nuint8 " + name + "=" + std::to_string(value) + "\n"));
  };
  TargetReport target{};
  const auto sent = [&] { return sent_of(target); };
  expect_constant("not_handled", sent().source);
  expect_constant("no_estimate", sent().estimate);
  for (const Verdict verdict : {Verdict::visible, Verdict::partial, Verdict::hidden,
                                Verdict::unknown, Verdict::out_of_view, Verdict::held}) {
    target.verdict = verdict;
    const std::string name(to_string(verdict));
    EXPECT_EQ(sent().verdict_name, name);
    expect_constant(verdict == Verdict::held ? "held_by_link" : name, sent().verdict);
  }
  target.handled = HandledTarget{};
  for (const Source source : {Source::measured, Source::predicted, Source::held, Source::lost}) {
    target.handled->source = source;
    expect_constant(std::string(to_string(source)), sent().source);
  }
  for (const Outcome outcome : {Outcome::accepted, Outcome::refused_verdict, Outcome::refused_gate,
                                Outcome::refused_late, Outcome::refused_invalid}) {
    target.estimate = outcome;
    expect_constant(std::string(to_string(outcome)), sent().estimate);
  }
}

// Which targets messages become, and under which names.

class TargetInboxTest : public testing::Test {
 protected:
  /// Identities by names.
  std::map<std::string, bool> taken() {
    std::map<std::string, bool> all;
    for (const Target& target : inbox_.take(last)) all[target.name] = target.has_identity;
    return all;
  }
  template <typename Detection>
  static Detection detection(const std::string& id, const std::string& class_id) {
    Detection one;
    one.id = id;
    one.results = {{{"other", 0.1}}, {{class_id, 0.9}}};
    return one;
  }
  static constexpr std::int64_t last = std::numeric_limits<std::int64_t>::max();  // of frames
  const Robot robot_ = test::arm();
  TargetInbox inbox_{robot_, "optical"};
  const MessageHeader header_{7, "optical"};
};

using Names = std::map<std::string, bool>;

TEST_F(TargetInboxTest, NamesMadeOfAPlaceAreNoIdentity) {
  const auto cup = [](const std::string& id) { return detection<Detection2DMessage>(id, "cup"); };
  inbox_.add("/d", Detection2DArrayMessage{header_, {cup(""), cup("7"), cup("")}});
  EXPECT_EQ(taken(), (Names{{"/d/cup", false}, {"/d/7", true}, {"/d/cup 2", false}}));
  inbox_.add("/d", Detection2DArrayMessage{header_, {cup("")}});
  EXPECT_EQ(taken(), (Names{{"/d/cup", false}})) << "the other may be the one that is hidden";
}

TEST_F(TargetInboxTest, IdsThatStandTwiceAreNone) {
  const auto cup = [](const std::string& id) { return detection<Detection3DMessage>(id, "cup"); };
  inbox_.add("/d", Detection3DArrayMessage{header_, {cup("7"), cup("8"), cup("7")}});
  EXPECT_EQ(taken(), (Names{{"/d/7", false}, {"/d/8", true}, {"/d/7 2", false}}));
  inbox_.add("/d", Detection3DArrayMessage{header_, {cup(""), cup("cup")}});
  EXPECT_EQ(taken(), (Names{{"/d/cup", false}, {"/d/cup 2", false}})) << "an id as a class is";
  inbox_.add("/d", Detection3DArrayMessage{header_, {cup("7"), cup("7"), cup("7 2")}});
  EXPECT_EQ(taken(), (Names{{"/d/7", false}, {"/d/7 2", false}, {"/d/7 2 2", false}}));
}

/// Tracking ids that are always new, and no image that they could be judged on.
TEST_F(TargetInboxTest, WhatIsNotTakenDoesNotPileUp) {
  constexpr std::int64_t frame = 33'000'000, start = 1'000'000'000'000;
  for (int i = 0; i < 20'000; ++i) {
    const std::string name = std::to_string(i);
    inbox_.add("/k", KeypointsMessage{{start + i * frame, "optical"}, {{.name = name}}});
    ASSERT_LE(inbox_.waiting(), TargetInbox::longest_lag / frame + 2);
  }
  EXPECT_EQ(inbox_.take(last).back().name, "/k/19999");
}

TEST_F(TargetInboxTest, WhatIsEarlierThanItsFrameWaitsForIt) {
  constexpr std::int64_t ms = 1'000'000, start = 1'000'000'000'000;
  const auto say = [&](std::int64_t stamp) {
    inbox_.add("/k", PoseStampedMessage{{stamp, "optical"}, {}});
  };
  const auto stamps = [&](std::int64_t frame) {
    std::vector<std::int64_t> all;
    for (const Target& target : inbox_.take(frame)) all.push_back(*target.stamp - start);
    return all;
  };
  using Stamps = std::vector<std::int64_t>;
  say(start + 100 * ms);
  say(start + 200 * ms);
  EXPECT_EQ(stamps(start), Stamps{});
  EXPECT_EQ(stamps(start + 100 * ms), Stamps{100 * ms});
  EXPECT_EQ(stamps(start + 300 * ms), Stamps{200 * ms}) << "its frame never came";
  say(start + 400 * ms);
  say(start + 500 * ms);
  EXPECT_EQ(stamps(start + 500 * ms), Stamps{500 * ms}) << "the newest of the name";
  EXPECT_EQ(inbox_.replaced(), 1U);
  say(start + 10'000 * ms);
  EXPECT_EQ(stamps(start + 600 * ms), Stamps{10'000 * ms}) << "of another clock";
}

}  // namespace
}  // namespace penumbra::io
