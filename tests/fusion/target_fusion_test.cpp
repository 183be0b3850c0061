// SPDX-License-Identifier: Apache-2.0
// Verdicts and points over cameras against closed forms.
#include "../support/test.hpp"

#include <penumbra/fusion/target_fusion.hpp>

namespace penumbra::test {
namespace {

ViewCamera camera_called(const std::string& name) {
  return {name, Intrinsics(640, 480, 600, 600, 320, 240), {.a = 0.01, .b = 0, .c = 0}};
}

/// A camera 1 m from the origin that looks at it; `angle` about z.
Isometry3d camera_at(double angle) {
  const Vector3d from(std::cos(angle), std::sin(angle), 0);
  Isometry3d pose = at(from);
  pose.linear().col(2) = -from;
  pose.linear().col(1) = -Vector3d::UnitZ();
  pose.linear().col(0) = pose.linear().col(1).cross(pose.linear().col(2));
  return pose;
}

/// Of a disc of 100 pixels at 1 m.
const double unit_radius = std::sqrt(100 / (M_PI * 600 * 600));

/// The point of the surface, seen by camera_at(angle), of a target with its centre at the origin:
/// half its radius before it.
Vector3d surface_at(double angle) {
  const double distance = 1 / (1 + unit_radius / 2);
  return (1 - distance) * camera_at(angle).translation();
}

/// One camera's frame with one target.
struct Shot {
  Shot(std::int64_t stamp, Verdict verdict, std::optional<Vector3d> point = {},
       double visible = 1.0, double angle = 0.0) {
    target.name = "part";
    target.stamp = stamp;
    target.verdict = verdict;
    target.judgement.emplace();
    target.judgement->verdict = verdict;
    target.judgement->covered = 100;
    target.judgement->clear = visible;
    target.point = point;
    if (verdict == Verdict::unknown) target.reason = "not measured";
    report.stamp = stamp;
    report.T_root_camera = camera_at(angle);
  }
  [[nodiscard]] const FrameReport& get() {
    report.targets = {&target, 1};
    return report;
  }
  TargetReport target;
  FrameReport report;
};

FrameReport without_targets(std::int64_t stamp) {
  FrameReport report;
  report.stamp = stamp;
  return report;
}

TargetFusion fusion_of(const std::vector<std::string>& names) {
  std::vector<ViewCamera> cameras;
  for (const std::string& name : names) cameras.push_back(camera_called(name));
  return TargetFusion(cameras);
}

TEST(TargetFusion, TheVerdictFollowsTheTableOfAllPairs) {
  using enum Verdict;
  const std::vector<Verdict> order{visible, partial, unknown, hidden, out_of_view};
  // The first of two in that order wins.
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = 0; b < order.size(); ++b) {
      TargetFusion views = fusion_of({"left", "right"});
      views.add(0, Shot(0, order[a]).get());
      views.add(1, Shot(0, order[b]).get());
      const FusedTarget target = views.fused("part");
      EXPECT_EQ(target.verdict, order[std::min(a, b)])
          << to_string(order[a]) << to_string(order[b]);
      EXPECT_EQ(target.reason.empty(), target.verdict != unknown);
      EXPECT_EQ(target.best.has_value(), std::min(a, b) < 2);
    }
}

TEST(TargetFusion, ASilentCameraIsUnknown) {
  TargetFusion views = fusion_of({"left", "right"});
  views.add(0, Shot(0, Verdict::hidden).get());
  EXPECT_EQ(views.fused("part").verdict, Verdict::unknown) << "the right one never had a frame";
  views.add(1, Shot(0, Verdict::hidden).get());
  EXPECT_EQ(views.fused("part").verdict, Verdict::hidden);
  views.add(0, Shot(100 * ms, Verdict::hidden).get());
  EXPECT_EQ(views.fused("part").verdict, Verdict::hidden) << "the window is 0.1 s";
  views.add(0, Shot(101 * ms, Verdict::hidden).get());
  EXPECT_EQ(views.fused("part").verdict, Verdict::unknown);
  EXPECT_TRUE(holds(views.fused("part").reason, "'right'"));
  views.add(1, without_targets(101 * ms));
  EXPECT_EQ(views.fused("part").verdict, Verdict::unknown) << "it judged the target before";
}

TEST(TargetFusion, ACameraThatNeverJudgesATargetIsNotAsked) {
  TargetFusion views = fusion_of({"left", "right"});
  views.add(1, without_targets(0));
  views.add(0, Shot(0, Verdict::hidden).get());
  EXPECT_EQ(views.fused("part").verdict, Verdict::hidden);
  EXPECT_EQ(views.fused("part").views.size(), 1U);
}

/// A tracker gives new names for ever, and the last views of an old one may contradict each other.
TEST(TargetFusion, ATargetThatIsJudgedNoLongerIsForgotten) {
  TargetFusion views = fusion_of({"left", "right"});
  views.add(0, Shot(0, Verdict::visible, Vector3d(0, 0, 0)).get());
  views.add(1, Shot(0, Verdict::visible, Vector3d(0, 0, 0.1)).get());
  EXPECT_TRUE(views.fused("part").contradiction);
  for (std::int64_t stamp = 0; stamp <= 1000 * ms; stamp += 100 * ms) {
    views.add(0, without_targets(stamp));
    EXPECT_EQ(views.fused().size(), 1U) << "ten windows have not passed";
  }
  views.add(0, without_targets(1001 * ms));
  EXPECT_TRUE(views.fused().empty());
  views.add(1, Shot(500 * ms, Verdict::hidden).get());
  EXPECT_EQ(views.fused("part").stamp, 500 * ms) << "of a camera that lags behind";
  Shot late(1002 * ms, Verdict::hidden);  // found in an old image
  late.target.stamp = -9000 * ms;
  views.add(0, late.get());
  views.add(1, without_targets(1003 * ms));
  EXPECT_EQ(views.fused().size(), 1U);
}

TEST(TargetFusion, FramesMayComeInAnyOrder) {
  TargetFusion views = fusion_of({"left"});
  views.add(0, Shot(50 * ms, Verdict::hidden).get());
  views.add(0, Shot(20 * ms, Verdict::visible).get());
  EXPECT_EQ(views.fused("part").verdict, Verdict::hidden);
  EXPECT_EQ(views.fused("part").stamp, 50 * ms);
}

TEST(TargetFusion, TheBestCameraSeesMostThenIsNearest) {
  TargetFusion views = fusion_of({"a", "b", "c"});
  const Vector3d near(0.1, 0, 0);
  views.add(0, Shot(0, Verdict::partial, near, 0.9, 0).get());
  views.add(1, Shot(0, Verdict::visible, near, 0.97, M_PI / 2).get());
  views.add(2, Shot(0, Verdict::visible, near, 0.98, M_PI / 4).get());
  const FusedTarget target = views.fused("part");
  EXPECT_EQ(target.verdict, Verdict::visible);
  ASSERT_TRUE(target.best);
  EXPECT_EQ(*target.best, 2U) << "0.97 and 0.98 are equal, and it is nearer";
  EXPECT_NEAR(target.views[1].distance, std::hypot(1, 0.1), 1e-12);
  EXPECT_NEAR(target.views[1].angle, std::atan(0.1), 1e-12);
}

TEST(TargetFusion, TwoCamerasAtRightAnglesHelpEachOther) {
  TargetFusion views = fusion_of({"x", "y"});
  views.add(0, Shot(0, Verdict::visible, surface_at(0), 1, 0).get());
  views.add(1, Shot(0, Verdict::visible, surface_at(M_PI / 2), 1, M_PI / 2).get());
  const FusedTarget target = views.fused("part");
  ASSERT_TRUE(target.point);
  EXPECT_LT(target.point->norm(), 1e-12);
  // The camera's pose within 5 mm, noise e / 2 = 5 mm along the ray, a pixel across, and of the
  // radius: along the ray the variance of what is evenly between 0 and 1, a twelfth; across a
  // twentieth.
  const double distance = (camera_at(0).translation() - surface_at(0)).norm();
  const double radius = distance * unit_radius;
  const double along = 2 * 0.005 * 0.005 + radius * radius / 12;
  const double across = 0.005 * 0.005 + distance * distance / (600.0 * 600) + radius * radius / 400;
  const double both = 1 / (1 / along + 1 / across);
  const Matrix3d expected = Vector3d(both, both, across / 2).asDiagonal();
  EXPECT_LT((target.covariance - expected).norm(), 1e-12);
}

TEST(TargetFusion, PointsAtDifferentPlacesAreAContradiction) {
  const auto fused_at = [](double apart) {
    TargetFusion views = fusion_of({"left", "middle", "right"});
    views.add(0, Shot(0, Verdict::visible, Vector3d(0, 0, 0)).get());
    views.add(1, Shot(0, Verdict::visible, Vector3d(0, 0, 0.4 * apart)).get());
    views.add(2, Shot(0, Verdict::visible, Vector3d(0, 0, apart)).get());
    return views.fused("part");
  };
  const double across =
      std::sqrt(0.005 * 0.005 + 1.0 / (600.0 * 600) + unit_radius * unit_radius / 400);
  const double limit = std::sqrt(16.27 * 2) * across;
  constexpr double oblique = 0.01;  // part of the limit: the rays to the points are not parallel
  EXPECT_TRUE(fused_at((1 - oblique) * limit).point);
  EXPECT_EQ(fused_at((1 - oblique) * limit).verdict, Verdict::visible);
  const FusedTarget apart = fused_at((1 + oblique) * limit);
  ASSERT_TRUE(apart.contradiction);
  EXPECT_EQ(apart.contradiction->first, 0U);
  EXPECT_EQ(apart.contradiction->second, 2U);
  EXPECT_NEAR(apart.contradiction->distance, limit, 2 * oblique * limit);
  EXPECT_EQ(apart.verdict, Verdict::unknown);
  EXPECT_FALSE(apart.point);
  EXPECT_TRUE(holds(apart.reason, "'left' and 'right'"));
}

TEST(TargetFusion, AHalfHiddenTargetMayBeAnywhereInIt) {
  const auto fused_at = [](double visible, double apart) {
    TargetFusion views = fusion_of({"left", "right"});
    views.add(0, Shot(0, Verdict::partial, Vector3d(0, 0, 0), visible).get());
    views.add(1, Shot(0, Verdict::visible, Vector3d(0, 0, apart)).get());
    return views.fused("part");
  };
  constexpr double apart = 0.04;  // metres; the disc's radius is 9.4 mm, a pose is known to 5 mm
  EXPECT_TRUE(fused_at(1.0, apart).contradiction);
  EXPECT_FALSE(fused_at(0.3, apart / 2).contradiction);
}

TEST(TargetFusion, FusedPointsAreAsGoodAsTheirCovarianceSays) {
  // The squared Mahalanobis distance of N points with three degrees of freedom has the mean 3 and
  // the standard deviation sqrt(6 / N).
  constexpr int points = 4000;
  std::mt19937_64 random = seeded_random(7);
  std::normal_distribution<double> normal;
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    TargetFusion views = fusion_of({"a", "b", "c"});
    for (std::size_t c = 0; c < 3; ++c) {
      const double angle = 2.0 * double(c);
      Shot exact(0, Verdict::visible, surface_at(angle), 1, angle);
      const auto frame = views_of(views.cameras()[c], exact.get());
      const Eigen::LLT<Matrix3d> root(frame.views.at("part").covariance);
      const Vector3d noise(normal(random), normal(random), normal(random));
      views.add(
          c, Shot(0, Verdict::visible, surface_at(angle) + root.matrixL() * noise, 1, angle).get());
    }
    const FusedTarget target = views.fused("part");
    if (!target.point) continue;  // one pair in a thousand
    sum += target.point->dot(target.covariance.inverse() * *target.point);
  }
  EXPECT_NEAR(sum / points, 3.0, 5 * std::sqrt(6.0 / points) + 0.02);
}

TEST(TargetFusion, RefusesWhatMeansNothing) {
  EXPECT_THROW(fusion_of({}), InputError);
  EXPECT_THROW(fusion_of({""}), InputError);
  EXPECT_THROW(fusion_of({"a", "a"}), InputError);
  EXPECT_THROW(TargetFusion({camera_called("a")}, {.window = 0}), InputError);
  EXPECT_THROW(TargetFusion({camera_called("a")}, {.window = inf}), InputError);
}

}  // namespace
}  // namespace penumbra::test
