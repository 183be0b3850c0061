// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <research/object_fit.hpp>
#include <research/robot_filters.hpp>
#include <research/statistics.hpp>

namespace penumbra::test {
namespace {

using namespace penumbra::research;

/// Runs of one frame whose position error is the given one, the target hidden.
struct Runs {
  explicit Runs(const std::vector<double>& errors) : seeds(errors.size()), methods(errors.size()) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      seeds[i].frame_seconds = 0.5;
      seeds[i].frames = {{1.0, true}, {0.0, true}};
      methods[i].success = false;
      methods[i].samples.resize(2);
      methods[i].samples[0].known = true;
      methods[i].samples[0].translation_error = errors[i];
    }
  }
  [[nodiscard]] std::vector<MethodOfSeed> all() const {
    std::vector<MethodOfSeed> all;
    for (std::size_t i = 0; i < seeds.size(); ++i) all.push_back({&seeds[i], &methods[i]});
    return all;
  }
  [[nodiscard]] double measured(const std::string& key) const {
    for (const Measure& measure : measures_of("conveyor"))
      if (measure.key == key) return *measure.value(all());
    throw std::out_of_range(key);
  }

  std::vector<SeedRun> seeds;
  std::vector<MethodRun> methods;
};

TEST(Measures, CountHiddenFramesAndThoseWithoutPose) {
  const Runs runs({0.010, 0.020, 0.030});
  EXPECT_DOUBLE_EQ(runs.measured("translation_median_mm"), 20.0);
  EXPECT_DOUBLE_EQ(runs.measured("without_pose_s"), 0.5);
  EXPECT_DOUBLE_EQ(runs.measured("success_percent"), 0.0);
}

TEST(Measures, CountWrongPosesThatWereAccepted) {
  Runs runs({0.010, 0.010});
  Event wrong;
  wrong.accepted = true;
  wrong.translation_error = 0.021;
  Event refused = wrong;
  refused.accepted = false;
  Event right = wrong;
  right.translation_error = 0.019;
  runs.methods[0].events = {wrong, refused, right};
  EXPECT_DOUBLE_EQ(runs.measured("wrong_accepted"), 0.5);
}

TEST(Bootstrap, OfAMeanHasTheWidthThatTheNormalDistributionSays) {
  std::vector<double> errors(100);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = 0.001 * static_cast<double>(i);
  const Runs runs(errors);
  Measure mean;
  mean.value = [](std::span<const MethodOfSeed> some) -> std::optional<double> {
    double sum = 0;
    for (const MethodOfSeed& run : some) sum += run.method->samples[0].translation_error;
    return sum / static_cast<double>(some.size());
  };
  const Interval interval = interval_of(mean, runs.all());
  ASSERT_TRUE(interval.confidence);
  const double sigma = 0.1 / std::sqrt(12.0) / std::sqrt(100.0);
  constexpr double slack = 0.15;  // 1000 resamples leave a few percent
  EXPECT_NEAR(interval.confidence->high - interval.confidence->low, 2 * 1.96 * sigma,
              slack * 2 * 1.96 * sigma);
  EXPECT_NEAR(*interval.value, 0.0495, 1e-12);
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

}  // namespace
}  // namespace penumbra::test
