// SPDX-License-Identifier: Apache-2.0
// The clean-up against LabelRule's words, spelled out pixel by pixel, and on scenes whose answer is
// known.
#include "../support/random.hpp"
#include "scene.hpp"

#include <gtest/gtest.h>

#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace {

using test::Scene;

/// LabelRule's clean-up by brute force: each question is asked anew of the images, nothing is kept.
struct Definition {
  const Scene& scene;
  const LabelRule& rule;

  [[nodiscard]] bool inside(int u, int v) const {
    return u >= 0 && v >= 0 && u < scene.width() && v < scene.height();
  }
  [[nodiscard]] bool measured(int u, int v) const {
    const float d = scene.metres(u, v);
    return d > 0.0f && d >= static_cast<float>(rule.range.near) &&
           d <= static_cast<float>(rule.range.far) && std::isfinite(d);
  }
  [[nodiscard]] bool before(int u, int v, float z) const {
    const auto a = static_cast<float>(rule.tolerance.a), b = static_cast<float>(rule.tolerance.b),
               c = static_cast<float>(rule.tolerance.c);
    return measured(u, v) && scene.metres(u, v) < z - (a + (b + c * z) * z);
  }
  [[nodiscard]] bool front(int u, int v) const {
    return scene.robot(u, v) > 0.0f && before(u, v, scene.robot(u, v));
  }
  [[nodiscard]] bool certain(int u, int v) const {
    if (!inside(u, v)) return false;
    if (rule.edge_margin == 0) return front(u, v);
    const int cells = (rule.edge_margin + LabelRule::cell - 1) / LabelRule::cell;
    const auto from = [&](int p) { return (p / LabelRule::cell - cells) * LabelRule::cell; };
    const int across = (2 * cells + 1) * LabelRule::cell;
    float nearest = std::numeric_limits<float>::infinity();
    for (int y = from(v); y < from(v) + across; ++y)
      for (int x = from(u); x < from(u) + across; ++x)
        if (inside(x, y) && scene.robot(x, y) > 0.0f)
          nearest = std::min(nearest, scene.robot(x, y));
    return std::isfinite(nearest) && before(u, v, nearest);
  }
  [[nodiscard]] bool counts_as_certain(int u, int v) const {
    if (!inside(u, v)) return false;
    if (measured(u, v)) return certain(u, v);
    bool left = false, right = false, above = false, below = false;
    for (int i = 1; i <= rule.front_min_width; ++i) {
      left |= certain(u - i, v);
      right |= certain(u + i, v);
      above |= certain(u, v - i);
      below |= certain(u, v + i);
    }
    return (left && right) || (above && below);
  }
  [[nodiscard]] bool solid_square(int u, int v) const {
    for (int y = v; y < v + rule.front_min_width; ++y)
      for (int x = u; x < u + rule.front_min_width; ++x)
        if (!counts_as_certain(x, y)) return false;
    return true;
  }
  [[nodiscard]] bool seed(int u, int v) const {
    if (!inside(u, v) || !front(u, v) || !certain(u, v)) return false;
    for (int y = v - rule.front_min_width + 1; y <= v; ++y)
      for (int x = u - rule.front_min_width + 1; x <= u; ++x)
        if (solid_square(x, y)) return true;
    return false;
  }
  [[nodiscard]] bool stays_front(int u, int v) const {
    if (!front(u, v)) return false;
    const int reach = rule.edge_margin / 2;
    for (int y = v - reach; y <= v + reach; ++y)
      for (int x = u - reach; x <= u + reach; ++x)
        if (seed(x, y)) return true;
    return false;
  }
};

TEST(Definition, HoldsForEveryTarget) {
  auto random = test::seeded_random(31);
  std::size_t kept = 0, dropped = 0;
  for (int i = 0; i < 24; ++i) {
    LabelRule rule;
    rule.fringe_reach = 0;  // fringe_test.cpp
    rule.front_min_width = 1 + static_cast<int>(random() % 4);
    rule.edge_margin = static_cast<int>(random() % 7);
    const int width = 20 + static_cast<int>(random() % 60),
              height = 8 + static_cast<int>(random() % 20);
    const Scene scene = test::random_scene(width, height, random);
    const Definition definition{scene, rule};
    for (const std::string& isa : test::every_isa()) {
      Classifier classifier(width, height, rule, isa);
      const LabelView view = classifier.classify(scene.view(), scene.metres.view());
      for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
          const bool front = view.labels(u, v) == static_cast<std::uint8_t>(Label::front);
          ASSERT_EQ(front, definition.stays_front(u, v))
              << isa << " pixel " << u << ',' << v << " of scene " << i;
          kept += front;
          dropped += !front && definition.front(u, v);
        }
      }
    }
  }
  EXPECT_GT(kept, 1000u);  // the scenes ask both answers
  EXPECT_GT(dropped, 1000u);
}

class Cleanup : public testing::TestWithParam<std::string> {
 protected:
  static constexpr int width = 160, height = 96;
  static constexpr float wall = 2.0f, robot = 1.0f, object = 0.9f;

  /// A robot in columns 40..119 before a wall.
  Cleanup() : scene(width, height) {
    fill(scene.metres, wall, 0, 0, width, height);
    fill(scene.robot, robot, 40, 0, 120, height);
    fill(scene.metres, robot, 40, 0, 120, height);
    scene.mark_tiles();
  }

  static void fill(Image<float>& image, float z, int u0, int v0, int u1, int v1) {
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u) image(u, v) = z;
  }

  std::size_t front_pixels() {
    Classifier classifier(width, height, LabelRule{}, GetParam());
    return classifier.classify(scene.view(), scene.metres.view())
        .pixels[static_cast<std::size_t>(Label::front)];
  }

  Scene scene;
};

INSTANTIATE_TEST_SUITE_P(Isa, Cleanup, testing::ValuesIn(test::every_isa()),
                         [](const auto& isa) { return isa.param; });

TEST_P(Cleanup, DropsWhatIsNarrow) {
  fill(scene.metres, object, 60, 10, 66, 60);  // six pixels wide, front_min_width is 7
  EXPECT_EQ(front_pixels(), 0u);
  fill(scene.metres, object, 60, 10, 67, 60);
  EXPECT_EQ(front_pixels(), 350u);
}

TEST_P(Cleanup, KeepsTheStripOfAnObjectThatReachesPastTheRobot) {
  fill(scene.metres, object, 117, 30, 140, 60);  // three pixels of it are on the robot
  EXPECT_EQ(front_pixels(), 90u);
}

TEST_P(Cleanup, DropsANearLinkSeenOutOfPlace) {
  // A near link in columns 80..119 that the sensor sees eight pixels further left.
  fill(scene.robot, 0.6f, 80, 0, 120, height);
  fill(scene.metres, 0.6f, 72, 0, 120, height);
  EXPECT_EQ(front_pixels(), 0u);
}

TEST_P(Cleanup, AHoledObjectStaysWhole) {
  fill(scene.metres, object, 60, 30, 90, 60);
  std::size_t holes = 0;
  for (int v = 32; v < 58; v += 2)
    for (int u = 60; u < 90; ++u, ++holes) scene.metres(u, v) = 0.0f;
  EXPECT_EQ(front_pixels(), 900u - holes);
}

TEST_P(Cleanup, UntouchedTilesBesideTheRobotSupportItsObjects) {
  // The robot ends with its tile, so that what carries its last columns lies in an untouched one.
  fill(scene.robot, 0.0f, 96, 0, width, height);
  scene.mark_tiles();
  ASSERT_EQ(scene.tiles.rows[4] >> 3, 0u);
  fill(scene.metres, wall, 96, 0, width, height);
  fill(scene.metres, object, 93, 30, 125, 60);
  EXPECT_EQ(front_pixels(), 90u);
}

}  // namespace
}  // namespace penumbra
