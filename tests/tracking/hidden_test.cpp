// SPDX-License-Identifier: Apache-2.0
// A target is seen, hidden while a detector goes on inventing poses, and seen again: predictions
// stay as near to the truth as they say, and the target is found again.
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "random_motion.hpp"
#include "tracks.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr double period = 0.1;
constexpr int seen_frames = 20, hidden_frames = 15;

struct Hidden {
  int axes = 0;
  int outside = 0;          // errors beyond 3 sigma
  double squares = 0;       // of errors in sigmas
  int found = 0, runs = 0;  // again, within two estimates
};

void hide(const PoseTrackerConfig& config, std::mt19937_64& random, Hidden& hidden) {
  RandomMotion target(config, random);
  PoseTracker tracker(config);
  for (int i = 0; i < seen_frames; ++i) {
    tracker.update(target.estimate(i * period), Verdict::visible);
    target.advance(period);
  }
  for (int i = seen_frames; i < seen_frames + hidden_frames; ++i) {
    auto invented = target.estimate(i * period);
    invented.pose.translation() += 0.1 * normal<3>(random);
    const Verdict verdict = i % 2 == 0 ? Verdict::hidden : Verdict::unknown;
    ASSERT_EQ(tracker.update(invented, verdict), Outcome::refused_verdict);
    const auto pose = tracker.at(invented.stamp);
    ASSERT_NE(pose.source, Source::measured);
    const Vector6d error = difference(target.pose(), pose.pose);
    const Vector6d scaled = error.cwiseQuotient(pose.covariance.diagonal().cwiseSqrt());
    hidden.axes += 6;
    hidden.outside += static_cast<int>((scaled.cwiseAbs().array() > 3).count());
    hidden.squares += scaled.squaredNorm();
    target.advance(period);
  }
  const double back = (seen_frames + hidden_frames) * period;
  bool accepted = tracker.update(target.estimate(back), Verdict::visible) == Outcome::accepted;
  target.advance(period);
  accepted |= tracker.update(target.estimate(back + period), Verdict::visible) == Outcome::accepted;
  hidden.found += accepted ? 1 : 0;
  ++hidden.runs;
}

class HiddenPhase : public testing::TestWithParam<PoseTrackerConfig> {};

TEST_P(HiddenPhase, PredictionsStayWithinThreeSigma) {
  constexpr double most_outside = 0.01;  // of Gauss's 0.27 %: errors of one run hang together
  constexpr double sound = 0.15;         // of the mean square, likewise
  constexpr double found = 0.97;         // the gate refuses 1 %, and twice in a row hardly any
  auto random = seeded_random(451);
  Hidden hidden;
  for (int run = 0; run < samples(150); ++run) hide(GetParam(), random, hidden);
  EXPECT_LT(hidden.outside, most_outside * hidden.axes);
  EXPECT_NEAR(hidden.squares / hidden.axes, 1, sanitized ? 3 * sound : sound);
  EXPECT_GE(hidden.found, found * hidden.runs);
}

INSTANTIATE_TEST_SUITE_P(Motions, HiddenPhase, testing::ValuesIn(all_motions()));

}  // namespace
}  // namespace penumbra::test
