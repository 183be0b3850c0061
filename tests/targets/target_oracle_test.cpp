// SPDX-License-Identifier: Apache-2.0
// Random targets on random frames against a judge that asks every pixel.
#include "target_oracle.hpp"

#include "../support/random.hpp"
#include "target_regions.hpp"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

constexpr double rounding = 1e-12;       // of fractions
constexpr double depth_rounding = 1e-6;  // metres: means of floats near 1 m
constexpr std::size_t link_count = 5;

void expect_same(const Judgement& judged, const test::NaiveJudgement& naive) {
  ASSERT_EQ(judged.inside, naive.inside);
  if (naive.inside == 0) return;
  const auto share = [&](std::size_t pixels) {
    return static_cast<double>(pixels) / static_cast<double>(naive.inside);
  };
  EXPECT_NEAR(judged.clear, share(naive.clear), rounding);
  EXPECT_NEAR(judged.front, share(naive.front), rounding);
  EXPECT_NEAR(judged.occluded, share(naive.occluded), rounding);
  EXPECT_NEAR(judged.unknown, share(naive.unknown), rounding);
  EXPECT_NEAR(judged.hidden_by_other.value_or(0), share(naive.other), rounding);
  EXPECT_NEAR(judged.measured.value_or(-1), share(naive.measured), rounding);
  EXPECT_NEAR(judged.seen_past.value_or(0), share(naive.past), rounding);
  ASSERT_EQ(judged.blame.size(), naive.blame.size());
  for (std::size_t i = 0; i < judged.blame.size(); ++i) {
    const Blame& blame = judged.blame[i];
    ASSERT_TRUE(naive.blame.contains(blame.link)) << blame.link;
    EXPECT_NEAR(blame.fraction, share(naive.blame.at(blame.link)), rounding);
    EXPECT_LE(blame.fraction, judged.blame[i == 0 ? 0 : i - 1].fraction);
  }
}

/// Regions of more pixels are sampled.
constexpr std::size_t sampled_pixels = 1000;

/// Five standard errors of the rank of a median of some 1,000 samples, and of how many of them are
/// trusted.
constexpr double sampling = 5 * 0.5 / 31.6;

/// The depth that a share of the sorted depths lies below.
double quantile(const std::vector<float>& sorted, double share) {
  const double last = static_cast<double>(sorted.size() - 1);
  return static_cast<double>(sorted[static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * last)]);
}

void expect_same_point(const Judgement& judged, const test::NaiveJudgement& naive) {
  const bool seen = judged.verdict == Verdict::visible || judged.verdict == Verdict::partial;
  const auto trusted = static_cast<double>(naive.trusted.size());
  const auto inside = static_cast<double>(naive.inside);
  const bool is_sampled = naive.inside > sampled_pixels;
  if (!is_sampled || trusted > sampling * inside || naive.trusted.empty()) {
    ASSERT_EQ(judged.point.has_value(), seen && !naive.trusted.empty());
  }
  if (!judged.point) return;
  if (!is_sampled) {
    EXPECT_EQ(judged.point_pixels, naive.trusted.size());
    EXPECT_NEAR(judged.point->z(), naive.median(), depth_rounding);
    EXPECT_NEAR(judged.point_spread, naive.spread(), depth_rounding);
    return;
  }
  EXPECT_NEAR(static_cast<double>(judged.point_pixels), trusted, sampling * inside);
  const double rank = sampling * std::sqrt(inside / trusted);
  EXPECT_GE(judged.point->z(), quantile(naive.trusted, 0.5 - rank) - depth_rounding);
  EXPECT_LE(judged.point->z(), quantile(naive.trusted, 0.5 + rank) + depth_rounding);
}

class TargetOracle : public testing::Test {
 protected:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  std::size_t below(std::size_t end) { return random() % end; }

  struct Shape {
    Region region;
    Image<std::uint8_t> mask;
    test::Corners corners;
    std::vector<std::uint32_t> counts;
    Image<float> depth;
    std::size_t covered = 0;   // pixels by geometry, outside of the image too
    double covered_error = 0;  // by which the count may be off
  };

  /// A region, and its pixels by geometry.
  void choose_shape(Shape& shape, int width, int height) {
    const Eigen::Vector2d centre(number(0, width), number(0, height));
    const auto paint = [&](const auto& place) {
      constexpr int margin = 50;  // pixels around the image that hold all of it
      shape.mask = Image<std::uint8_t>(width, height);
      for (int v = -margin; v < height + margin; ++v) {
        for (int u = -margin; u < width + margin; ++u) {
          if (place(Eigen::Vector2d(u, v)) != test::Place::inside) continue;
          ++shape.covered;
          if (u >= 0 && v >= 0 && u < width && v < height) shape.mask(u, v) = 1;
        }
      }
    };
    const std::size_t kind = below(7);
    if (kind == 0) {
      const PixelBox box{centre.x() - 8, centre.y() - 9, number(2, 40), number(2, 40)};
      shape.region = box;
      paint([&](const auto& p) { return test::place_in_box(box, p); });
      return;
    }
    if (kind >= 5) {  // a star, or an outline that crosses itself
      if (kind == 5)
        shape.corners = test::random_star(random, centre, number(5, 40), 3 + below(30));
      for (std::size_t n = kind == 5 ? 0 : 4 + below(8); n > 0; --n)
        shape.corners.emplace_back(number(-30, width + 30), number(-30, height + 30));
      shape.region = PixelPolygon{shape.corners};
      paint([&](const auto& p) { return test::place_in_polygon(shape.corners, p); });
      return;
    }
    const PixelEllipse ellipse{centre, {number(2, 25), number(2, 25)}, number(0, 3)};
    shape.region = ellipse;
    paint([&](const auto& p) { return test::place_in_ellipse(ellipse, p); });
    shape.covered_error = test::area_error(ellipse, width, height);
    if (kind == 1) return;
    shape.covered = 0;
    shape.covered_error = 0;
    shape.mask(static_cast<int>(below(static_cast<std::size_t>(width))), 0) = 1;
    if (kind == 2) shape.region = PixelMask{shape.mask.view()};
    if (kind == 3) {
      shape.counts = test::run_lengths(shape.mask.view());
      shape.region = RunLengthMask{width, height, shape.counts};
    }
    if (kind == 4) {
      shape.depth = Image<float>(width, height);
      for (std::size_t i = 0; i < shape.mask.size(); ++i)
        if (shape.mask.data()[i] != 0) shape.depth.data()[i] = static_cast<float>(number(0.7, 1.3));
      shape.region = RenderedRegion{.depth = shape.depth.view(), .touched = nullptr};
    }
  }

  /// What the i-th target asks for: all thresholds are out of the way.
  static TargetView asked(const Shape& shape, int i) {
    TargetView target;
    target.region = shape.region;
    target.depth_margin = i % 3 == 0 ? 0.05 : 0;
    target.thresholds.beyond_hides = i % 2 == 0;
    target.thresholds.point_min_pixels = 1;
    target.thresholds.point_min_fraction = 0;
    target.thresholds.min_measured = 0;
    target.thresholds.hidden_enter = 1;
    target.thresholds.unknown_limit = target.thresholds.past_limit = 1;
    return target;
  }

  /// The depth that a target is expected at, told to it or rendered.
  Image<float> choose_depth(const Shape& shape, TargetView& target) {
    if (!shape.depth.empty()) return shape.depth;
    if (below(2) != 0) return {shape.mask.width(), shape.mask.height()};
    target.expected_depth = number(0.6, 1.4);
    return {shape.mask.width(), shape.mask.height(), static_cast<float>(*target.expected_depth)};
  }

  /// A random target, by both judges.
  void compare(TargetJudge& judge, test::NaiveTarget naive, int i) {
    Shape shape;
    choose_shape(shape, naive.labels.width, naive.labels.height);
    const std::string name = "target " + std::to_string(i);
    SCOPED_TRACE(name);
    TargetView target = asked(shape, i);
    const Image<float> expected = choose_depth(shape, target);
    naive.mask = shape.mask.view();
    naive.expected = expected.view();
    naive.depth_margin = static_cast<float>(target.depth_margin);
    naive.beyond_hides = target.thresholds.beyond_hides;
    const test::NaiveJudgement truth = naive.judge();
    const Judgement judged = judge.judge(target);
    expect_same(judged, truth);
    const std::size_t covered =
        std::max<std::size_t>(shape.covered > 0 ? shape.covered : truth.inside, 1);
    EXPECT_NEAR(static_cast<double>(judged.covered), static_cast<double>(covered),
                shape.covered_error);
    expect_same_point(judged, truth);
    points += judged.point ? 1 : 0;
    others += truth.other > 0 ? 1 : 0;
    passed += truth.past > 0 ? 1 : 0;
    blamed += truth.blame.size() > 1 ? 1 : 0;
  }

  std::mt19937_64 random = test::seeded_random(42);
  std::size_t points = 0, others = 0, blamed = 0, passed = 0;  // targets that had any
};

/// Metres where the sensor measures, else 0.
Image<float> measured_of(const Image<float>& metres, const Image<std::uint16_t>& millimetres,
                         bool in_metres, const DepthRange& range) {
  Image<float> measured(metres.width(), metres.height());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const float d =
        in_metres ? metres.data()[i] : 0.001f * static_cast<float>(millimetres.data()[i]);
    const double exact = in_metres ? static_cast<double>(d) : millimetres.data()[i] / 1000.0;
    const bool valid = exact > 0 && std::isfinite(d) && exact >= range.near &&
                       static_cast<float>(exact) <= static_cast<float>(range.far) &&
                       static_cast<float>(exact) >= static_cast<float>(range.near);
    measured.data()[i] = valid ? d : 0.0f;
  }
  return measured;
}

Image<std::uint16_t> links_of(const Image<float>& robot) {
  Image<std::uint16_t> links(robot.width(), robot.height());
  for (int v = 0; v < robot.height(); ++v)
    for (int u = 0; u < robot.width(); ++u)
      if (robot(u, v) > 0)
        links(u, v) = static_cast<std::uint16_t>((u / 13 + v / 17) % (link_count + 1));
  return links;
}

TEST_F(TargetOracle, AgreesOnRandomFrames) {
  const int width = 101, height = 67;
  for (int frame = 0; frame < 60; ++frame) {
    test::Scene scene = test::random_scene(width, height, random);
    if (frame % 5 == 0) scene.robot = Image<float>(width, height), scene.mark_tiles();
    LabelRule rule = frame % 3 == 0 ? LabelRule::paper() : LabelRule{};
    if (frame % 4 == 0) rule.range = {0.4, 1.45};
    const Image<std::uint16_t> millimetres = scene.millimetres();
    const bool in_metres = frame % 2 == 0;
    const DepthView depth =
        in_metres ? DepthView(scene.metres.view()) : DepthView(millimetres.view());
    const Image<float> measured = measured_of(scene.metres, millimetres, in_metres, rule.range);
    const Image<std::uint16_t> links = links_of(scene.robot);

    Classifier classifier(width, height, rule);
    LabelledImages images{classifier.classify(scene.view(), depth), scene.view(), depth};
    images.virtual_depth.links = links.view();
    if (frame % 7 == 0) images.labels.touched = nullptr;
    TargetJudge judge({Intrinsics(width, height, 90, 91, 49, 33), {}, {}, {}}, rule, link_count);
    judge.begin(images);

    SCOPED_TRACE("frame " + std::to_string(frame));
    const test::NaiveTarget naive{.rule = rule,
                                  .labels = images.labels.labels,
                                  .robot = scene.robot.view(),
                                  .links = links.view(),
                                  .measured = measured.view(),
                                  .mask = {},
                                  .expected = {}};
    for (int i = 0; i < 8; ++i) ASSERT_NO_FATAL_FAILURE(compare(judge, naive, i));
  }
  EXPECT_GT(points, 100u);
  EXPECT_GT(others, 50u);
  EXPECT_GT(blamed, 50u);
  EXPECT_GT(passed, 50u);
}

}  // namespace
}  // namespace penumbra
