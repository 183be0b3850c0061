// SPDX-License-Identifier: Apache-2.0
// Every SIMD target gives the labels of the reference, bit by bit.
#include "../support/random.hpp"
#include "label_reference.hpp"
#include "scene.hpp"

#include <gtest/gtest.h>

#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace {

using test::Scene;

std::vector<std::uint8_t> pixels(const LabelView& view) {
  std::vector<std::uint8_t> all;
  for (int v = 0; v < view.labels.height; ++v)
    all.insert(all.end(), view.labels.row(v), view.labels.row(v) + view.labels.width);
  return all;
}

/// A copy of the image with another stride, upside down if that is negative.
template <typename T>
struct Strided {
  Strided(const Image<T>& image, std::ptrdiff_t stride)
      : memory(static_cast<std::size_t>(std::abs(stride) * (image.height() - 1) + image.width())) {
    const std::ptrdiff_t start = stride < 0 ? -stride * (image.height() - 1) : 0;
    const ImageView<T> out{memory.data() + start, image.width(), image.height(), stride};
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u) out(u, v) = image(u, v);
    view = out;
  }
  std::vector<T> memory;  // of the exact size, so that ASan finds reads past the end
  ImageView<const T> view;
};

/// Without fringe, every target agrees with the reference, otherwise with the first target.
template <typename T>
void expect_same(const Scene& scene, std::vector<Classifier>& classifiers, std::ptrdiff_t stride,
                 const Image<T>& depth) {
  const LabelRule& rule = classifiers.front().rule();
  const Strided<float> robot(scene.robot, scene.width() + 3);
  const Strided<T> measured(depth, stride);
  const VirtualDepthView view{.depth = robot.view, .links = {}, .touched = &scene.tiles};
  std::vector<std::uint8_t> expected = pixels(classifiers.front().classify(view, measured.view));
  if (rule.fringe_reach == 0) {
    const test::LabelReference<T> reference(rule, robot.view, measured.view);
    std::transform(reference.labels().data(), reference.labels().data() + expected.size(),
                   expected.begin(), [](Label label) { return static_cast<std::uint8_t>(label); });
  }
  std::array<std::size_t, label_count> counts{};
  for (const std::uint8_t label : expected) ++counts[label];
  for (Classifier& classifier : classifiers) {
    const LabelView got = classifier.classify(view, measured.view);
    ASSERT_EQ(pixels(got), expected)
        << classifier.isa() << ' ' << scene.width() << 'x' << scene.height() << " width "
        << rule.front_min_width << " margin " << rule.edge_margin;
    ASSERT_EQ(got.pixels, counts) << classifier.isa();
  }
}

void expect_same(const Scene& scene, std::vector<Classifier>& classifiers, std::ptrdiff_t stride,
                 bool in_metres) {
  if (in_metres)
    expect_same(scene, classifiers, stride, scene.metres);
  else
    expect_same(scene, classifiers, stride, scene.millimetres());
}

std::vector<Classifier> one_of_each(int width, int height, const LabelRule& rule) {
  std::vector<Classifier> classifiers;
  for (const std::string& isa : simd_target_names())
    classifiers.emplace_back(width, height, rule, isa);
  return classifiers;
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

TEST(Twins, AgreeOnEverySmallSize) {
  auto random = test::seeded_random(11);
  for (int width = 1; width <= 70; ++width) {
    const int height = 1 + static_cast<int>(random() % 20);
    const LabelRule rule = random_rule(random);
    auto classifiers = one_of_each(width, height, rule);
    for (int i = 0; i < 6; ++i) {
      const Scene scene = test::random_scene(width, height, random);
      const std::ptrdiff_t gap = static_cast<std::ptrdiff_t>(random() % 5);
      const std::ptrdiff_t stride = i % 2 == 0 ? width + gap : -(width + gap);
      expect_same(scene, classifiers, stride, i % 3 == 0);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Twins, AgreeAcrossTilesAndFrames) {
  auto random = test::seeded_random(12);
  for (int i = 0; i < 40; ++i) {
    const int width = 100 + static_cast<int>(random() % 200);
    const int height = 30 + static_cast<int>(random() % 80);
    const LabelRule rule = random_rule(random);
    auto classifiers = one_of_each(width, height, rule);
    for (int frame = 0; frame < 5; ++frame) {
      expect_same(test::random_scene(width, height, random), classifiers, width, frame % 2 == 0);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Twins, AgreeOnWideImagesWhoseTilesAreWide) {
  auto random = test::seeded_random(13);
  for (const int width : {2049, 2600, 4097}) {
    LabelRule rule;
    rule.fringe_reach = width == 2600 ? 40 : 0;
    auto classifiers = one_of_each(width, 40, rule);
    for (int frame = 0; frame < 3; ++frame)
      expect_same(test::random_scene(width, 40, random), classifiers, width, false);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace penumbra
