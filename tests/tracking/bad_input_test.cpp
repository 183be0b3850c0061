// SPDX-License-Identifier: Apache-2.0
// Configurations and estimates that cannot be right.
#include "../support/errors.hpp"
#include "tracks.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

TEST(TrackerConfig, SaysWhichFieldIsWrong) {
  using Config = PoseTrackerConfig;
  const std::vector<std::pair<std::string, Config>> faults{
      {"position_sigma 0", {.position_sigma = 0}},
      {"orientation_sigma nan", {.orientation_sigma = nan}},
      {"acceleration -1", {.acceleration = -1}},
      {"angular_drift -1", {.angular_drift = -1}},
      {"timeout 0", {.timeout = 0}},
      {"gate_patience 0", {.gate_patience = 0}},
      {"max_estimates 1", {.max_estimates = 1}},
      {"worst unknown", {.worst = Verdict::unknown}},
      {"direction is (0, 0, 0)", {.motion = Motion::along_direction}},
      {"speed is given", {.speed = 1}}};
  for (const auto& [part, config] : faults) expect_refused([&c = config] { c.check(); }, {part});
}

/// What becomes of an estimate that was right before `spoil`.
Outcome outcome_of(const std::function<void(PoseEstimate&)>& spoil) {
  PoseTracker tracker;
  PoseEstimate estimate;
  estimate.covariance = Matrix6d::Identity();
  spoil(estimate);
  const Outcome outcome = tracker.update(estimate, Verdict::visible);
  EXPECT_EQ(tracker.at(0).source, outcome == Outcome::accepted ? Source::measured : Source::lost);
  return outcome;
}

TEST(BadEstimates, AreRefusedAsInvalid) {
  using Estimate = PoseEstimate;
  EXPECT_EQ(outcome_of([](Estimate&) {}), Outcome::accepted);
  const std::vector<std::function<void(Estimate&)>> faults{
      [](Estimate& e) { e.pose.translation().y() = nan; },
      [](Estimate& e) { e.pose.translation().x() = inf; },
      [](Estimate& e) { e.pose.linear()(0, 1) = nan; },
      [](Estimate& e) { e.pose.linear().setZero(); },
      [](Estimate& e) { e.pose.linear() *= 1.001; },
      [](Estimate& e) { e.pose.linear()(2, 2) = -1; },
      [](Estimate& e) { e.pose.linear()(0, 1) = 1e-3; },
      [](Estimate& e) { (*e.covariance)(0, 0) = nan; },
      [](Estimate& e) { (*e.covariance)(3, 3) = -1; },
      [](Estimate& e) { (*e.covariance)(4, 4) = 0; },
      [](Estimate& e) { (*e.covariance)(0, 1) = 0.5; },
      [](Estimate& e) { (*e.covariance)(0, 1) = (*e.covariance)(1, 0) = 1.5; },
      [](Estimate& e) { e.covariance->setZero(); },
      [](Estimate& e) { *e.covariance *= 1e30; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    EXPECT_EQ(outcome_of(faults[i]), Outcome::refused_invalid) << "fault " << i;
  }
}

TEST(BadEstimates, RotationsOfTextFilesAreTaken) {
  Eigen::Matrix3d rounded = turn({0.3, -1.2, 0.8});
  rounded = (rounded * 1e5).array().round() / 1e5;
  PoseTracker tracker;
  PoseEstimate estimate;
  estimate.pose.linear() = rounded;
  EXPECT_EQ(tracker.update(estimate, Verdict::visible), Outcome::accepted);
  const Eigen::Matrix3d kept = tracker.at(0).pose.linear();
  EXPECT_LT((kept.transpose() * kept - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((kept - rounded).norm(), 3e-5);  // nine entries, each rounded by half a digit
}

}  // namespace
}  // namespace penumbra::test
