// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/base/image.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra::test {

/// A virtual and a measured depth image of one size, with the tiles of the former.
struct Scene {
  Scene(int width, int height)
      : robot(width, height), metres(width, height), tiles(width, height) {}

  [[nodiscard]] int width() const { return robot.width(); }
  [[nodiscard]] int height() const { return robot.height(); }

  void mark_tiles() {
    std::fill(tiles.rows.begin(), tiles.rows.end(), 0);
    for (const auto [u, v] : each_pixel(*this))
      if (robot(u, v) > 0.0f) tiles.mark(u, v, u, v);
  }

  [[nodiscard]] VirtualDepthView view() const {
    return {.depth = robot.view(), .links = {}, .touched = &tiles};
  }

  Image<float> robot;
  Image<float> metres;
  TileMask tiles;
};

/// Robot-like patches at 0.5..1.5 m with steps between them, seen with noise, objects before them,
/// holes and values that are no measurement.
inline Scene random_scene(int width, int height, std::mt19937_64& random) {
  Scene scene(width, height);
  const auto number = [&](double low, double high) {
    return float(std::uniform_real_distribution<double>(low, high)(random));
  };
  const auto below = [&](int end) {
    return std::uniform_int_distribution<int>(0, end - 1)(random);
  };
  const auto fill = [&](Image<float>& image, float z, int largest) {
    const int u0 = below(width), v0 = below(height);
    const int u1 = std::min(width, u0 + 1 + below(largest)),
              v1 = std::min(height, v0 + 1 + below(largest));
    for (const auto [u, v] : each_pixel(u0, v0, u1, v1)) image(u, v) = z;
  };
  for (int i = below(6); i > 0; --i) fill(scene.robot, number(0.5, 1.5), 1 + width / 2);
  for (std::size_t i = 0; i < scene.metres.size(); ++i) {
    const float z = scene.robot.data()[i];
    scene.metres.data()[i] = (z > 0.0f ? z : 1.5f) + number(-0.03, 0.03);
  }
  for (int i = below(8); i > 0; --i) fill(scene.metres, number(0.3, 1.4), 24);
  for (int i = below(8); i > 0; --i) fill(scene.metres, 0.0f, 8);
  const float odd[] = {0.0f,
                       -0.0f,
                       -1.0f,
                       std::numeric_limits<float>::infinity(),
                       std::numeric_limits<float>::quiet_NaN(),
                       65.535f};
  for (int i = below(1 + width * height / 20); i > 0; --i)
    scene.metres(below(width), below(height)) = odd[below(6)];
  scene.mark_tiles();
  return scene;
}

inline std::size_t count(const LabelView& view, Label label) {
  return view.pixels[std::size_t(label)];
}

/// A test for each SIMD target.
class IsaTest : public ::testing::TestWithParam<std::string> {};

}  // namespace penumbra::test

#define PENUMBRA_FOR_EACH_ISA(suite)                                                       \
  INSTANTIATE_TEST_SUITE_P(Isa, suite, ::testing::ValuesIn(penumbra::simd_target_names()), \
                           [](const auto& isa) { return isa.param; })
