// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <research/follower.hpp>
#include <research/object_fit.hpp>
#include <research/robot_filters.hpp>
#include <research/statistics.hpp>

namespace penumbra::test {
namespace {

using namespace penumbra::research;

TEST(Quantile, LiesBetweenTheTwoNearestValues) {
  EXPECT_FALSE(quantile({}, 0.5));
  EXPECT_EQ(quantile({7.0}, 0.95), 7.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_EQ(quantile({2.0, 1.0}, 1.0), 2.0);
}

/// Runs of one frame whose position error is the given one, the target hidden.
std::pair<std::vector<SeedRun>, std::vector<MethodRun>> runs_of(const std::vector<double>& errors) {
  std::vector<SeedRun> seeds;
  std::vector<MethodRun> methods;
  for (const double error : errors) {
    SeedRun seed;
    seed.frame_seconds = 0.5;
    seed.frames = {{1.0, true}, {0.0, true}};
    seeds.push_back(seed);
    MethodRun method;
    method.success = false;
    method.samples.resize(2);
    method.samples[0].known = true;
    method.samples[0].translation_error = error;
    methods.push_back(method);
  }
  return {seeds, methods};
}

std::vector<MethodOfSeed> methods_of(
    const std::pair<std::vector<SeedRun>, std::vector<MethodRun>>& runs) {
  std::vector<MethodOfSeed> all;
  for (std::size_t i = 0; i < runs.first.size(); ++i)
    all.push_back({&runs.first[i], &runs.second[i]});
  return all;
}

const Measure& measure_named(const std::vector<Measure>& measures, const std::string& key) {
  for (const Measure& measure : measures)
    if (measure.key == key) return measure;
  throw std::out_of_range(key);
}

TEST(Measures, CountHiddenFramesAndThoseWithoutPose) {
  const auto runs = runs_of({0.010, 0.020, 0.030});
  const auto measures = measures_of("conveyor");
  const auto all = methods_of(runs);
  EXPECT_DOUBLE_EQ(*measure_named(measures, "translation_median_mm").value(all), 20.0);
  EXPECT_DOUBLE_EQ(*measure_named(measures, "without_pose_s").value(all), 0.5);
  EXPECT_DOUBLE_EQ(*measure_named(measures, "success_percent").value(all), 0.0);
}

TEST(Measures, CountWrongPosesThatWereAccepted) {
  auto runs = runs_of({0.010, 0.010});
  Event wrong;
  wrong.accepted = true;
  wrong.translation_error = 0.021;
  Event refused = wrong;
  refused.accepted = false;
  Event right = wrong;
  right.translation_error = 0.019;
  runs.second[0].events = {wrong, refused, right};
  EXPECT_DOUBLE_EQ(
      *measure_named(measures_of("conveyor"), "wrong_accepted").value(methods_of(runs)), 0.5);
}

TEST(Bootstrap, OfAMeanHasTheWidthThatTheNormalDistributionSays) {
  std::vector<double> errors(100);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = 0.001 * static_cast<double>(i);
  const auto runs = runs_of(errors);
  Measure mean;
  mean.value = [](std::span<const MethodOfSeed> some) -> std::optional<double> {
    double sum = 0;
    for (const MethodOfSeed& run : some) sum += run.method->samples[0].translation_error;
    return sum / static_cast<double>(some.size());
  };
  const Interval interval = interval_of(mean, methods_of(runs));
  ASSERT_TRUE(interval.confidence);
  const double sigma = 0.1 / std::sqrt(12.0) / std::sqrt(100.0);
  constexpr double slack = 0.15;  // 1000 resamples leave a few percent
  EXPECT_NEAR(interval.confidence->high - interval.confidence->low, 2 * 1.96 * sigma,
              slack * 2 * 1.96 * sigma);
  EXPECT_NEAR(*interval.value, 0.0495, 1e-12);
}

/// R's poisson.test and binom.test, to their digits.
TEST(Confidence, IsTheExactOneOfTables) {
  constexpr double digits = 5e-5;
  EXPECT_EQ(count_confidence(0).low, 0.0);
  EXPECT_NEAR(count_confidence(0).high, 3.6889, digits);
  EXPECT_NEAR(count_confidence(1).low, 0.0253, digits);
  EXPECT_NEAR(count_confidence(1).high, 5.5716, digits);
  EXPECT_NEAR(count_confidence(5).low, 1.6235, digits);
  EXPECT_NEAR(count_confidence(5).high, 11.6683, digits);
  EXPECT_EQ(fraction_confidence(0, 30).low, 0.0);
  EXPECT_NEAR(fraction_confidence(0, 30).high, 0.1157, digits);
  EXPECT_NEAR(fraction_confidence(3, 30).low, 0.0211, digits);
  EXPECT_NEAR(fraction_confidence(3, 30).high, 0.2653, digits);
  EXPECT_NEAR(fraction_confidence(30, 30).low, 0.8843, digits);
  EXPECT_EQ(fraction_confidence(30, 30).high, 1.0);
}

/// "None of 30" leaves room for some; so does "all".
TEST(Confidence, OfNoneAndAllIsNotCertainty) {
  auto runs = runs_of(std::vector<double>(30, 0.01));
  for (MethodRun& run : runs.second) {
    run.success = true;
    run.events = {{.seen = true}};
  }
  const auto all = methods_of(runs);
  const auto conveyor = measures_of("conveyor"), handover = measures_of("handover");
  const Interval wrong = interval_of(measure_named(conveyor, "wrong_accepted"), all);
  EXPECT_EQ(wrong.value, 0.0);
  EXPECT_NEAR(wrong.confidence.value().high, 3.6889 / 30, 1e-4);
  const Interval picks = interval_of(measure_named(conveyor, "success_percent"), all);
  EXPECT_EQ(picks.value, 100.0);
  EXPECT_NEAR(picks.confidence.value().low, 88.43, 0.01);
  const Interval refused = interval_of(measure_named(handover, "refused_visible_percent"), all);
  EXPECT_EQ(refused.value, 100.0);
  EXPECT_NEAR(refused.confidence.value().low, 88.43, 0.01);
  const Interval median = interval_of(measure_named(conveyor, "translation_median_mm"), all);
  EXPECT_FALSE(median.confidence) << "every resample is the same";
  const Interval one =
      interval_of(measure_named(conveyor, "success_percent"), std::span(all).first(1));
  EXPECT_FALSE(one.confidence) << "of one seed";
}

TEST(BoxDepth, IsWhereARayEntersTheBox) {
  Eigen::Isometry3d T_object_camera = Eigen::Isometry3d::Identity();
  T_object_camera.translation().z() = -2;
  const Eigen::Vector3d size(0.4, 0.2, 0.6);
  EXPECT_DOUBLE_EQ(box_depth(T_object_camera, size, {0, 0, 1}), 1.7);
  EXPECT_DOUBLE_EQ(box_depth(T_object_camera, size, {0.1, 0, 1}), 1.7);
  EXPECT_EQ(box_depth(T_object_camera, size, {0.2, 0, 1}), 0.0);
}

/// realtime_urdf_filter's shader, by hand: the robot drawn at 1 m, 5 cm allowed before it.
TEST(RobotFilters, TheUrdfFilterKeepsWhatStandsBeforeTheRobotAndTheSilhouetteNothing) {
  struct Case {
    std::uint16_t measured;  // millimetres
    float drawn;             // metres
    bool by_urdf_filter, by_silhouette;
    const char* what;
  };
  const std::array<Case, 6> cases{{{600, 1.0F, false, true, "well before the robot"},
                                   {949, 1.0F, false, true, "just more than 5 cm before it"},
                                   {951, 1.0F, true, true, "just less than 5 cm before it"},
                                   {1000, 1.0F, true, true, "the robot"},
                                   {3000, 1.0F, true, true, "beyond it"},
                                   {1000, 0.0F, false, false, "beside it"}}};
  for (const Case& one : cases) {
    const Image<std::uint16_t> depth(1, 1, one.measured), missing(1, 1, 0);
    const Image<float> drawn(1, 1, one.drawn);
    Observation observed;
    observed.depth = depth.view();
    EXPECT_FALSE(urdf_filtered(observed, 0, 0) || on_silhouette(observed, 0, 0)) << "nothing drawn";
    observed.robot.virtual_depth.depth = drawn.view();
    EXPECT_EQ(urdf_filtered(observed, 0, 0), one.by_urdf_filter) << one.what;
    EXPECT_EQ(on_silhouette(observed, 0, 0), one.by_silhouette) << one.what;
    observed.depth = missing.view();
    EXPECT_FALSE(urdf_filtered(observed, 0, 0)) << "nothing measured";
  }
}

/// Accepts estimates with x above 1.
class FakeFollower : public Follower {
 public:
  std::vector<double> taken;
  TrackedPose at(std::int64_t /*stamp*/) const override { return {}; }

 protected:
  bool take(const PoseEstimate& estimate, Verdict /*verdict*/) override {
    taken.push_back(estimate.pose.translation().x());
    return taken.back() > 1;
  }
};

Answer answer_at(double x) {
  Answer answer;
  answer.estimate.emplace();
  answer.estimate->pose.translation().x() = x;
  return answer;
}

TEST(Follower, TakesWhatHasArrivedInTheOrderOfArrival) {
  FakeFollower follower;
  std::vector<Event> events;
  follower.post(300, answer_at(1), {});
  follower.post(100, answer_at(2), {});
  follower.post(200, {}, {});
  follower.post(100, answer_at(3), {});
  follower.deliver(99, events);
  EXPECT_TRUE(follower.taken.empty());
  follower.deliver(250, events);
  EXPECT_EQ(follower.taken, (std::vector<double>{2, 3}));
  EXPECT_EQ(events.size(), 3U);
  follower.deliver(300, events);
  EXPECT_EQ(follower.taken, (std::vector<double>{2, 3, 1}));
  EXPECT_FALSE(events.back().accepted);
  EXPECT_TRUE(events.front().accepted);
}

TEST(Follower, TheLastEstimateIsTheNewestWhateverArrivesAfterIt) {
  const auto follower = make_last_estimate();
  std::vector<Event> events;
  Answer newer = answer_at(2);
  newer.estimate->stamp = 50;
  EXPECT_EQ(follower->at(60).source, Source::lost);
  follower->post(100, newer, {});
  follower->post(110, answer_at(1), {});
  follower->deliver(120, events);
  EXPECT_EQ(follower->at(120).pose.translation().x(), 2);
}

}  // namespace
}  // namespace penumbra::test
