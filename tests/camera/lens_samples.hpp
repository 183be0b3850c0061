// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/camera/camera.hpp>

namespace penumbra::test {

struct Lens {
  std::string name;  ///< for messages
  std::string model;
  std::vector<double> coefficients;

  [[nodiscard]] Distortion distortion() const { return {model, coefficients}; }
};

/// Coefficients such as calibrations of real cameras give, and strong textbook ones.
inline std::vector<Lens> typical_lenses() {
  return {
      {"barrel", "plumb_bob", {-0.3, 0, 0, 0, 0}},
      {"pincushion", "plumb_bob", {0.3, 0.1, 0, 0, 0}},
      {"webcam", "plumb_bob", {-0.2834, 0.0741, 0.00019, 1.76e-05, -0.0089}},
      {"tangential", "plumb_bob", {-0.25, 0.08, 0.02, -0.015, 0}},
      {"moustache", "plumb_bob", {-0.4, 0.25, 0.001, -0.002, -0.06}},
      {"colour camera of RealSense kind",
       "plumb_bob",
       {-0.0554, 0.0648, 0.00047, -0.00028, -0.0206}},
      {"wide time-of-flight of Azure Kinect kind",
       "rational_polynomial",
       {5.227, 3.519, -5.18e-05, 2.2e-05, 0.182, 5.557, 5.229, 0.966}},
      {"colour of Azure Kinect kind",
       "rational_polynomial",
       {0.4533, -2.5526, 0.00064, -0.00026, 1.4875, 0.3302, -2.375, 1.4141}},
      {"rational with a pole", "rational_polynomial", {0.2, 0, 0, 0, 0, -0.5, 0, 0}},
      {"ideal fisheye", "equidistant", {0, 0, 0, 0}},
      {"tracking camera of T265 kind", "equidistant", {-0.0079, 0.0431, -0.0410, 0.0076}},
      {"action camera of GoPro kind", "equidistant", {0.0385, 0.0216, -0.0184, 0.0037}},
      {"folding fisheye", "equidistant", {-0.3, 0.05, 0, -0.02}},
  };
}

/// A lens of a random model with strong random coefficients, of either sign.
inline Lens random_lens(std::mt19937_64& random) {
  std::uniform_real_distribution<double> radial(-0.6, 0.6);
  std::uniform_real_distribution<double> tangential(-0.02, 0.02);
  switch (random() % 3) {
    case 0:
      return {"random",
              "plumb_bob",
              {radial(random), radial(random), tangential(random), tangential(random),
               0.5 * radial(random)}};
    case 1:
      return {"random",
              "rational_polynomial",
              {radial(random), radial(random), tangential(random), tangential(random),
               0.5 * radial(random), radial(random), radial(random), 0.5 * radial(random)}};
    default:
      return {"random",
              "equidistant",
              {radial(random), 0.5 * radial(random), 0.2 * radial(random), 0.1 * radial(random)}};
  }
}

/// A point at most `share` of the way to the edge of what the lens maps, at most 80 degrees off the
/// axis, and put where an image may still be.
inline Vector2d random_point_inside(const Distortion& lens, double share, std::mt19937_64& random) {
  constexpr double widest_image = 3;  // of the plane z = 1
  const double steep = std::tan(80 * std::numbers::pi / 180);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (double r = std::min(share * lens.max_radius(), steep);;) {
    r *= std::sqrt(unit(random));
    const double angle = 2 * std::numbers::pi * unit(random);
    Vector2d p(r * std::cos(angle), r * std::sin(angle));
    if (lens.distort(p).norm() <= widest_image) return p;
  }
}

}  // namespace penumbra::test
