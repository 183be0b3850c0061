// SPDX-License-Identifier: Apache-2.0
// Every SIMD target gives the labels of the reference, bit by bit.
#include "scene.hpp"

namespace penumbra::test {
namespace {

/// LabelRule without its fringe as plain loops over whole images, in its own words.
template <typename T>
class LabelReference {
 public:
  LabelReference(const LabelRule& rule, ImageView<const float> robot, ImageView<const T> measured)
      : rule_(rule),
        robot_(robot),
        measured_(measured),
        width_(robot.width),
        height_(robot.height) {
    labels_ = map([&](int u, int v) { return label_of(u, v); });
    if (rule_.front_min_width > 0) clean_up();
  }

  [[nodiscard]] const Image<Label>& labels() const { return labels_; }

 private:
  template <typename F>
  auto map(F&& f) const {
    Image<decltype(f(0, 0))> image(width_, height_);
    for (const auto [u, v] : each_pixel(image)) image(u, v) = f(u, v);
    return image;
  }

  [[nodiscard]] bool is_inside(int u, int v) const {
    return u >= 0 && v >= 0 && u < width_ && v < height_;
  }
  [[nodiscard]] float tolerance(float z) const {
    const auto a = float(rule_.tolerance.a);
    const auto b = float(rule_.tolerance.b);
    const auto c = float(rule_.tolerance.c);
    return a + (b + c * z) * z;
  }
  [[nodiscard]] bool is_measured(int u, int v) const {
    float d = metres_of(measured_(u, v));
    if (d == 0.0f) return false;
    if constexpr (!std::is_same_v<T, float>) d = float(measured_(u, v) / 1000.0);
    return float(rule_.range.near) <= d && d <= float(rule_.range.far);
  }

  [[nodiscard]] Label label_of(int u, int v) const {
    const float z = robot_(u, v);
    if (!(z > 0.0f)) return Label::clear;
    if (!is_measured(u, v)) return Label::unknown;
    const float d = metres_of(measured_(u, v)), e = tolerance(z);
    if (d < z - e) return Label::front;
    const bool is_past = d > z + float(rule_.beyond_factor) * e;
    return is_past && !rule_.fold_beyond ? Label::beyond : Label::occluded;
  }

  /// The nearest virtual depth of each cell, infinite without robot.
  [[nodiscard]] Image<float> nearest_of_cells() const {
    Image<float> cells(width_ / LabelRule::cell + 1, height_ / LabelRule::cell + 1,
                       std::numeric_limits<float>::infinity());
    for (const auto [u, v] : each_pixel(robot_)) {
      float& cell = cells(u / LabelRule::cell, v / LabelRule::cell);
      if (robot_(u, v) > 0.0f) cell = std::min(cell, robot_(u, v));
    }
    return cells;
  }

  [[nodiscard]] bool is_certain(const Image<float>& cells, int u, int v) const {
    if (!is_measured(u, v)) return false;
    if (rule_.edge_margin == 0) return labels_(u, v) == Label::front;
    const int reach = (rule_.edge_margin + LabelRule::cell - 1) / LabelRule::cell;
    const int i0 = u / LabelRule::cell, j0 = v / LabelRule::cell;
    float nearest = std::numeric_limits<float>::infinity();
    for (int j = std::max(0, j0 - reach); j <= std::min(cells.height() - 1, j0 + reach); ++j)
      for (int i = std::max(0, i0 - reach); i <= std::min(cells.width() - 1, i0 + reach); ++i)
        nearest = std::min(nearest, cells(i, j));
    return std::isfinite(nearest) && metres_of(measured_(u, v)) < nearest - tolerance(nearest);
  }

  /// Whether a certain pixel lies in a direction, at most front_min_width pixels away.
  [[nodiscard]] bool has_certain(const Image<char>& certain, int u, int v, int du, int dv) const {
    for (int i = 1; i <= rule_.front_min_width; ++i)
      if (is_inside(u + i * du, v + i * dv) && certain(u + i * du, v + i * dv) != 0) return true;
    return false;
  }

  [[nodiscard]] bool all_of_square(const Image<char>& image, int u, int v) const {
    for (int y = v; y < v + rule_.front_min_width; ++y)
      for (int x = u; x < u + rule_.front_min_width; ++x)
        if (!is_inside(x, y) || image(x, y) == 0) return false;
    return true;
  }

  void clean_up() {
    const Image<float> cells = nearest_of_cells();
    const Image<char> certain = map([&](int u, int v) -> char { return is_certain(cells, u, v); });
    const Image<char> counts = map([&](int u, int v) -> char {
      const auto has = [&](int du, int dv) { return has_certain(certain, u, v, du, dv); };
      return certain(u, v) != 0 ||
             (!is_measured(u, v) && ((has(-1, 0) && has(1, 0)) || (has(0, -1) && has(0, 1))));
    });
    Image<char> seeds(width_, height_);
    for (const auto [u, v] : each_pixel(seeds)) {
      if (!all_of_square(counts, u, v)) continue;
      for (int y = v; y < v + rule_.front_min_width; ++y)
        for (int x = u; x < u + rule_.front_min_width; ++x)
          seeds(x, y) |= labels_(x, y) == Label::front && certain(x, y) != 0;
    }
    const int reach = rule_.edge_margin / 2;
    labels_ = map([&](int u, int v) {
      if (labels_(u, v) != Label::front) return labels_(u, v);
      for (int y = std::max(0, v - reach); y <= std::min(height_ - 1, v + reach); ++y)
        for (int x = std::max(0, u - reach); x <= std::min(width_ - 1, u + reach); ++x)
          if (seeds(x, y) != 0) return Label::front;
      return Label::occluded;
    });
  }

  LabelRule rule_;
  ImageView<const float> robot_;
  ImageView<const T> measured_;
  int width_;
  int height_;
  Image<Label> labels_;
};

/// A copy of the image with another stride, upside down if that is negative.
template <typename T>
struct Strided {
  Strided(const Image<T>& image, std::ptrdiff_t stride)
      : memory(std::size_t(std::abs(stride) * (image.height() - 1) + image.width())) {
    const std::ptrdiff_t start = stride < 0 ? -stride * (image.height() - 1) : 0;
    const ImageView<T> out{memory.data() + start, image.width(), image.height(), stride};
    for (const auto [u, v] : each_pixel(image)) out(u, v) = image(u, v);
    view = out;
  }
  std::vector<T> memory;  // of the exact size, so that ASan finds reads past the end
  ImageView<const T> view;
};

/// Every target agrees with the reference; with fringe, with a first one that saw no other frame.
template <typename T>
void expect_same(const Scene& scene, std::vector<Classifier>& classifiers, std::ptrdiff_t stride,
                 const Image<T>& depth) {
  const LabelRule& rule = classifiers.front().rule();
  const Strided<float> robot(scene.robot, scene.width() + 3);
  const Strided<T> measured(depth, stride);
  const VirtualDepthView view{.depth = robot.view, .links = {}, .touched = &scene.tiles};
  Classifier fresh(scene.width(), scene.height(), rule, classifiers.front().isa());
  std::vector<std::uint8_t> expected = pixels_of(fresh.classify(view, measured.view).labels);
  if (rule.fringe_reach == 0) {
    const LabelReference<T> reference(rule, robot.view, measured.view);
    std::transform(reference.labels().data(), reference.labels().data() + expected.size(),
                   expected.begin(), [](Label label) { return std::uint8_t(label); });
  }
  std::array<std::size_t, label_count> counts{};
  for (const std::uint8_t label : expected) ++counts[label];
  for (Classifier& classifier : classifiers) {
    const LabelView got = classifier.classify(view, measured.view);
    ASSERT_EQ(pixels_of(got.labels), expected)
        << classifier.isa() << ' ' << scene.width() << 'x' << scene.height() << " width "
        << rule.front_min_width << " margin " << rule.edge_margin;
    ASSERT_EQ(got.pixels, counts) << classifier.isa();
  }
}

LabelRule random_rule(std::mt19937_64& random) {
  LabelRule rule;
  const auto pick = [&](auto... values) {
    const int all[] = {values...};
    return all[random() % sizeof...(values)];
  };
  rule.front_min_width = pick(0, 1, 2, 3, 5, 7, 7, 9, 16, 33, 63);
  rule.edge_margin = pick(0, 1, 4, 5, 8, 8, 13, 32, 64);
  rule.fringe_reach = pick(0, 0, 40);
  rule.fold_beyond = random() % 4 == 0;
  if (random() % 2 == 0) rule.range = {0.45, 1.3};
  if (random() % 2 == 0) rule.tolerance = {0.005, 0.004, 0.01};
  return rule;
}

/// In frames of one size.
void expect_same(std::mt19937_64& random, int width, int height, const LabelRule& rule,
                 int frames = 6) {
  std::vector<Classifier> classifiers;
  for (const std::string& isa : simd_target_names())
    classifiers.emplace_back(width, height, rule, isa);
  for (int i = 0; i < frames; ++i) {
    const Scene scene = random_scene(width, height, random);
    const std::ptrdiff_t step = width + std::ptrdiff_t(random() % 5);
    const std::ptrdiff_t stride = i % 2 == 0 ? step : -step;
    if (i % 3 == 0)
      expect_same(scene, classifiers, stride, scene.metres);
    else
      expect_same(scene, classifiers, stride, to_millimetres(scene.metres));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Twins, AgreeOnEverySmallSize) {
  auto random = seeded_random(11);
  for (int width = 1; width <= 70 && !HasFatalFailure(); ++width)
    expect_same(random, width, 1 + int(random() % 20), random_rule(random));
}

TEST(Twins, AgreeAcrossTilesAndFrames) {
  auto random = seeded_random(12);
  for (int i = 0; i < 40 && !HasFatalFailure(); ++i)
    expect_same(random, 100 + int(random() % 200), 30 + int(random() % 80), random_rule(random));
}

TEST(Twins, AgreeOnWideImagesWhoseTilesAreWide) {
  auto random = seeded_random(13);
  for (const int width : {2049, 2600, 4097}) {
    LabelRule rule;
    rule.fringe_reach = width == 2600 ? 40 : 0;
    expect_same(random, width, 40, rule, 3);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace penumbra::test
