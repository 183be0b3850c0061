// SPDX-License-Identifier: Apache-2.0
// Random targets on random frames against a judge that asks every pixel, in words of TargetJudge's
// docstring.
#include "../labels/scene.hpp"

#include <penumbra/targets/target_judge.hpp>

namespace penumbra::test {
namespace {

using Corners = std::vector<Vector2d>;

/// By the sum of the angles under which the edges are seen, full turns of either sign.
bool is_in_polygon(const Corners& corners, const Vector2d& p) {
  double angle = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d x = corners[i] - p, y = corners[(i + 1) % corners.size()] - p;
    angle += std::atan2(x.x() * y.y() - x.y() * y.x(), x.dot(y));
  }
  return std::abs(angle) > std::numbers::pi;
}

bool is_in_ellipse(const PixelEllipse& ellipse, const Vector2d& p) {
  const Vector2d d = p - ellipse.centre;
  const double c = std::cos(ellipse.angle), s = std::sin(ellipse.angle);
  return std::hypot((c * d.x() + s * d.y()) / ellipse.semi_axes.x(),
                    (c * d.y() - s * d.x()) / ellipse.semi_axes.y()) < 1;
}

/// How far the number of pixels in an ellipse can be from its area: half the length of a convex
/// outline and 1 (Nosarzewska 1948), and half a pixel that rounding adds. 0 if all of the ellipse
/// lies in the image: then its pixels are counted.
double area_error(const PixelEllipse& ellipse, int width, int height) {
  const double c = std::cos(ellipse.angle), s = std::sin(ellipse.angle);
  const double a = ellipse.semi_axes.x(), b = ellipse.semi_axes.y();
  const Eigen::Array2d reach(std::hypot(a * c, b * s), std::hypot(a * s, b * c));
  const Eigen::Array2d low = ellipse.centre.array() - reach, high = ellipse.centre.array() + reach;
  if (low.minCoeff() >= 0 && high.x() <= width - 1 && high.y() <= height - 1) return 0;
  const double longest_outline = std::numbers::pi * std::sqrt(2 * (a * a + b * b));
  return longest_outline / 2 + 1.5;
}

bool is_in_box(const PixelBox& box, const Vector2d& p) {
  return box.u <= p.x() && p.x() < box.u + box.width && box.v <= p.y() &&
         p.y() < box.v + box.height;
}

/// A polygon around a point of which all of its outline is seen, so that no edges cross.
Corners random_star(std::mt19937_64& random, const Vector2d& centre, double radius,
                    std::size_t corners) {
  std::uniform_real_distribution<double> share(0.1, 1.0), jitter(0.0, 0.9);
  const bool reversed = random() % 2 == 0;
  Corners star;
  for (std::size_t i = 0; i < corners; ++i) {
    const double turn = 2 * std::numbers::pi * (double(i) + jitter(random)) / double(corners);
    const double angle = reversed ? -turn : turn;
    star.push_back(centre + radius * share(random) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return star;
}

/// COCO's counts of a mask.
std::vector<std::uint32_t> run_lengths(ImageView<const std::uint8_t> mask) {
  std::vector<std::uint32_t> counts{0};
  bool inside = false;
  for (int u = 0; u < mask.width; ++u)
    for (int v = 0; v < mask.height; ++v) {
      if ((mask(u, v) != 0) != inside) {
        counts.push_back(0);
        inside = !inside;
      }
      ++counts.back();
    }
  return counts;
}

struct NaiveJudgement {
  std::size_t inside = 0, clear = 0, front = 0, occluded = 0, unknown = 0, other = 0;
  std::size_t measured = 0, past = 0;        // of the clear and front ones
  std::map<std::size_t, std::size_t> blame;  // pixels by link
  std::vector<float> trusted;                // sorted

  [[nodiscard]] double median() const { return double(trusted[trusted.size() / 2]); }
  [[nodiscard]] double spread() const {
    NaiveJudgement deviations;
    for (const float d : trusted) deviations.trusted.push_back(std::abs(d - float(median())));
    std::sort(deviations.trusted.begin(), deviations.trusted.end());
    return 1.4826 * deviations.median();
  }
};

/// A frame and a target of it as the naive judge takes them: images in metres, measurements out of
/// range 0, expected depth per pixel (0: none).
struct NaiveTarget {
  const LabelRule& rule;
  ImageView<const std::uint8_t> labels;
  ImageView<const float> robot;
  ImageView<const std::uint16_t> links;
  ImageView<const float> measured;
  ImageView<const std::uint8_t> mask;
  ImageView<const float> expected;
  float depth_margin = 0;
  bool beyond_hides = true;

  [[nodiscard]] float tolerance(float z) const {
    const auto a = float(rule.tolerance.a), b = float(rule.tolerance.b),
               c = float(rule.tolerance.c);
    return a + (b + c * z) * z;
  }

  void look(int u, int v, NaiveJudgement& result) const {
    auto label = static_cast<Label>(labels(u, v));
    if (label == Label::beyond) label = beyond_hides ? Label::occluded : Label::clear;
    const bool is_fringe = label == Label::fringe;  // it hides nothing and measures nothing
    if (is_fringe) label = Label::clear;
    const float z = robot(u, v), d = is_fringe ? 0 : measured(u, v), ze = expected(u, v);
    if (ze > 0) {
      const float m = tolerance(ze) + depth_margin;
      const bool on_robot = label != Label::clear;
      const bool robot_before = on_robot && z<ze - m, robot_behind = z> ze + m;
      if (robot_before) {
        label = Label::occluded;
      } else if (d > 0 && d < ze - m) {
        if (label != Label::occluded) {
          ++result.other;
          return;
        }
      } else if (on_robot && label != Label::front) {
        label = robot_behind ? Label::clear : Label::unknown;
      }
    }
    const bool is_seen = label == Label::clear || label == Label::front;
    if (is_seen && d > 0) ++result.measured;
    if (ze > 0 && is_seen && d > ze + (tolerance(ze) + depth_margin)) ++result.past;
    if (label == Label::clear) ++result.clear;
    if (label == Label::front) ++result.front;
    if (label == Label::unknown) ++result.unknown;
    if (label != Label::occluded) return;
    ++result.occluded;
    if (links(u, v) > 0) ++result.blame[links(u, v) - 1u];
  }

  [[nodiscard]] bool trusted(int u, int v) const {
    const auto label = static_cast<Label>(labels(u, v));
    const float d = measured(u, v), ze = expected(u, v);
    if ((label != Label::clear && label != Label::front) || !(d > 0)) return false;
    const float m = tolerance(ze) + depth_margin;
    if (ze > 0 && (d < ze - m || d > ze + m)) return false;
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
    const int cells = (std::max(rule.edge_margin, 8) + 3) / 4;
    for (const auto [x, y] : each_pixel(robot)) {
      if (std::abs(x / 4 - u / 4) > cells || std::abs(y / 4 - v / 4) > cells) continue;
      if (!(robot(x, y) > 0)) continue;
      nearest = std::min(nearest, robot(x, y));
      farthest = std::max(farthest, robot(x, y));
    }
    if (farthest == 0) return true;
    const float past = float(rule.beyond_factor) * tolerance(farthest);
    return d < nearest - tolerance(nearest) || d > farthest + past;
  }

  [[nodiscard]] NaiveJudgement judge() const {
    NaiveJudgement result;
    for (const auto [u, v] : each_pixel(mask)) {
      if (mask(u, v) == 0) continue;
      ++result.inside;
      look(u, v, result);
      if (trusted(u, v)) result.trusted.push_back(measured(u, v));
    }
    std::sort(result.trusted.begin(), result.trusted.end());
    return result;
  }
};

constexpr double rounding = 1e-12;       // of fractions
constexpr double depth_rounding = 1e-6;  // metres: means of floats near 1 m
constexpr std::size_t link_count = 5;

void expect_same(const Judgement& judged, const NaiveJudgement& naive) {
  ASSERT_EQ(judged.inside, naive.inside);
  if (naive.inside == 0) return;
  const auto share = [&](std::size_t pixels) { return double(pixels) / double(naive.inside); };
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
  const double last = double(sorted.size() - 1);
  return double(sorted[std::size_t(std::clamp(share, 0.0, 1.0) * last)]);
}

void expect_same_point(const Judgement& judged, const NaiveJudgement& naive) {
  const bool seen = judged.verdict == Verdict::visible || judged.verdict == Verdict::partial;
  const auto trusted = double(naive.trusted.size());
  const auto inside = double(naive.inside);
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
  EXPECT_NEAR(double(judged.point_pixels), trusted, sampling * inside);
  const double rank = sampling * std::sqrt(inside / trusted);
  EXPECT_GE(judged.point->z(), quantile(naive.trusted, 0.5 - rank) - depth_rounding);
  EXPECT_LE(judged.point->z(), quantile(naive.trusted, 0.5 + rank) + depth_rounding);
}

class TargetOracle : public testing::Test {
 protected:
  double number(double low, double high) { return uniform(random, low, high); }
  std::size_t below(std::size_t end) { return random() % end; }

  struct Shape {
    Region region;
    Image<std::uint8_t> mask;
    Corners corners;
    std::vector<std::uint32_t> counts;
    Image<float> depth;
    std::size_t covered = 0;   // pixels by geometry, outside of the image too
    double covered_error = 0;  // by which the count may be off
  };

  /// A region, and its pixels by geometry.
  void choose_shape(Shape& shape, int width, int height) {
    const Vector2d centre(number(0, width), number(0, height));
    const auto paint = [&](const auto& holds) {
      constexpr int margin = 50;  // pixels around the image that hold all of it
      shape.mask = Image<std::uint8_t>(width, height);
      for (const auto [u, v] : each_pixel(-margin, -margin, width + margin, height + margin)) {
        if (!holds(Vector2d(u, v))) continue;
        ++shape.covered;
        if (u >= 0 && v >= 0 && u < width && v < height) shape.mask(u, v) = 1;
      }
    };
    const std::size_t kind = below(7);
    if (kind == 0) {
      const PixelBox box{centre.x() - 8, centre.y() - 9, number(2, 40), number(2, 40)};
      shape.region = box;
      paint([&](const auto& p) { return is_in_box(box, p); });
      return;
    }
    if (kind >= 5) {  // a star, or an outline that crosses itself
      if (kind == 5) shape.corners = random_star(random, centre, number(5, 40), 3 + below(30));
      for (std::size_t n = kind == 5 ? 0 : 4 + below(8); n > 0; --n)
        shape.corners.emplace_back(number(-30, width + 30), number(-30, height + 30));
      shape.region = PixelPolygon{shape.corners};
      paint([&](const auto& p) { return is_in_polygon(shape.corners, p); });
      return;
    }
    const PixelEllipse ellipse{centre, {number(2, 25), number(2, 25)}, number(0, 3)};
    shape.region = ellipse;
    paint([&](const auto& p) { return is_in_ellipse(ellipse, p); });
    shape.covered_error = area_error(ellipse, width, height);
    if (kind == 1) return;
    shape.covered = 0;
    shape.covered_error = 0;
    shape.mask(int(below(std::size_t(width))), 0) = 1;
    if (kind == 2) shape.region = PixelMask{shape.mask.view()};
    if (kind == 3) {
      shape.counts = run_lengths(shape.mask.view());
      shape.region = RunLengthMask{width, height, shape.counts};
    }
    if (kind == 4) {
      shape.depth = Image<float>(width, height);
      for (std::size_t i = 0; i < shape.mask.size(); ++i)
        if (shape.mask.data()[i] != 0) shape.depth.data()[i] = float(number(0.7, 1.3));
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
    return {shape.mask.width(), shape.mask.height(), float(*target.expected_depth)};
  }

  /// A random target, by both judges.
  void compare(TargetJudge& judge, NaiveTarget naive, int i) {
    Shape shape;
    choose_shape(shape, naive.labels.width, naive.labels.height);
    const std::string name = "target " + std::to_string(i);
    SCOPED_TRACE(name);
    TargetView target = asked(shape, i);
    const Image<float> expected = choose_depth(shape, target);
    naive.mask = shape.mask.view();
    naive.expected = expected.view();
    naive.depth_margin = float(target.depth_margin);
    naive.beyond_hides = target.thresholds.beyond_hides;
    const NaiveJudgement truth = naive.judge();
    const Judgement judged = judge.judge(target);
    expect_same(judged, truth);
    const std::size_t covered =
        std::max<std::size_t>(shape.covered > 0 ? shape.covered : truth.inside, 1);
    EXPECT_NEAR(double(judged.covered), double(covered), shape.covered_error);
    expect_same_point(judged, truth);
    points += judged.point ? 1 : 0;
    others += truth.other > 0 ? 1 : 0;
    passed += truth.past > 0 ? 1 : 0;
    blamed += truth.blame.size() > 1 ? 1 : 0;
  }

  std::mt19937_64 random = seeded_random(42);
  std::size_t points = 0, others = 0, blamed = 0, passed = 0;  // targets that had any
};

/// Metres where the sensor measures, else 0.
Image<float> measured_of(const Image<float>& metres, const Image<std::uint16_t>& millimetres,
                         bool in_metres, const DepthRange& range) {
  Image<float> measured(metres.width(), metres.height());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const float d = in_metres ? metres.data()[i] : 0.001f * float(millimetres.data()[i]);
    const double exact = in_metres ? double(d) : millimetres.data()[i] / 1000.0;
    const bool valid = exact > 0 && std::isfinite(d) && exact >= range.near &&
                       float(exact) <= float(range.far) && float(exact) >= float(range.near);
    measured.data()[i] = valid ? d : 0.0f;
  }
  return measured;
}

Image<std::uint16_t> links_of(const Image<float>& robot) {
  Image<std::uint16_t> links(robot.width(), robot.height());
  for (const auto [u, v] : each_pixel(robot))
    if (robot(u, v) > 0) links(u, v) = std::uint16_t((u / 13 + v / 17) % (link_count + 1));
  return links;
}

TEST_F(TargetOracle, AgreesOnRandomFrames) {
  const int width = 101, height = 67;
  for (int frame = 0; frame < 60; ++frame) {
    Scene scene = random_scene(width, height, random);
    if (frame % 5 == 0) scene.robot = Image<float>(width, height), scene.mark_tiles();
    LabelRule rule = frame % 3 == 0 ? LabelRule::paper() : LabelRule{};
    if (frame % 4 == 0) rule.range = {0.4, 1.45};
    const Image<std::uint16_t> millimetres = to_millimetres(scene.metres);
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
    const NaiveTarget naive{.rule = rule,
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
}  // namespace penumbra::test
