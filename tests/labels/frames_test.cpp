// SPDX-License-Identifier: Apache-2.0
// One classifier over many frames: nothing of an earlier one is left, nothing is allocated.
#include "../support/allocations.hpp"
#include "../support/random.hpp"
#include "scene.hpp"

#include <gtest/gtest.h>

#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace {

class Frames : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Isa, Frames, testing::ValuesIn(simd_target_names()),
                         [](const auto& isa) { return isa.param; });

TEST_P(Frames, LeaveNothingToTheNext) {
  auto random = test::seeded_random(41);
  constexpr int width = 300, height = 70;
  Classifier used(width, height, LabelRule{}, GetParam());
  for (int i = 0; i < 60; ++i) {
    const test::Scene scene = test::random_scene(width, height, random);
    Classifier fresh(width, height, LabelRule{}, GetParam());
    const LabelView expected = fresh.classify(scene.view(), scene.metres.view());
    const LabelView got = used.classify(scene.view(), scene.metres.view());
    ASSERT_EQ(got.pixels, expected.pixels) << i;
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) ASSERT_EQ(got.labels(u, v), expected.labels(u, v)) << i;
  }
}

TEST_P(Frames, AllocateNothing) {
  auto random = test::seeded_random(44);
  Classifier classifier(300, 70, LabelRule{}, GetParam());
  std::vector<test::Scene> scenes;
  scenes.reserve(10);
  for (int i = 0; i < 10; ++i) scenes.push_back(test::random_scene(300, 70, random));
  const std::size_t before = test::allocations();
  for (const test::Scene& scene : scenes)
    (void)classifier.classify(scene.view(), scene.metres.view());
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace penumbra
