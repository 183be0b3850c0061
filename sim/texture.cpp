// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <sim/texture.hpp>

namespace penumbra::sim {
namespace {

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

Rgb8 any_color(Random& random) {
  return {to_byte(random.uniform(10, 250)), to_byte(random.uniform(10, 250)),
          to_byte(random.uniform(10, 250))};
}

/// Paints a rotated rectangle or ellipse at a random position.
void paint(Image<Rgb8>& image, Random& random, double size) {
  const double u0 = random.uniform(0, image.width()), v0 = random.uniform(0, image.height());
  const double a = size * random.uniform(0.4, 1.0), b = size * random.uniform(0.4, 1.0);
  const double angle = random.uniform(0.0, 3.141592653589793);
  const double c = std::cos(angle), s = std::sin(angle);
  const bool round = random.uniform() < 0.4;
  const Rgb8 color = any_color(random);
  const double reach = a + b;
  const int first_u = std::max(0, static_cast<int>(u0 - reach)),
            last_u = std::min(image.width() - 1, static_cast<int>(u0 + reach)),
            first_v = std::max(0, static_cast<int>(v0 - reach)),
            last_v = std::min(image.height() - 1, static_cast<int>(v0 + reach));
  for (int v = first_v; v <= last_v; ++v)
    for (int u = first_u; u <= last_u; ++u) {
      const double x = (c * (u - u0) + s * (v - v0)) / a, y = (c * (v - v0) - s * (u - u0)) / b;
      if (round ? x * x + y * y <= 1.0 : std::abs(x) <= 1.0 && std::abs(y) <= 1.0)
        image(u, v) = color;
    }
}

}  // namespace

Image<Rgb8> busy_print(int width, int height, Random& random) {
  Image<Rgb8> image(width, height, any_color(random));
  // Coarse shapes come first; each finer kind covers about the same area.
  for (const double share : {0.24, 0.14, 0.08, 0.05}) {
    const double size = share * width;
    const int count = static_cast<int>(0.35 * width * height / (size * size));
    for (int i = 0; i < count; ++i) paint(image, random, size);
  }
  return image;
}

Image<Rgb8> grain(int width, int height, Rgb8 color, int amplitude, Random& random) {
  Image<Rgb8> image(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double d = random.uniform(-amplitude, amplitude);
      image(u, v) = {to_byte(color.r + d), to_byte(color.g + d), to_byte(color.b + d)};
    }
  return image;
}

}  // namespace penumbra::sim
