// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>
#include <vector>

#include <penumbra/camera/distortion.hpp>

namespace penumbra::test {

struct Lens {
  std::string name;  ///< for messages
  std::string model;
  std::vector<double> coefficients;

  [[nodiscard]] Distortion distortion() const { return {model, coefficients}; }
};

/// Coefficients such as calibrations of real cameras give, and strong textbook ones.
std::vector<Lens> typical_lenses();

/// A lens of a random model with strong random coefficients, of either sign.
Lens random_lens(std::mt19937_64& random);

/// A point at most `share` of the way to the edge of what the lens maps, at most 80 degrees off the
/// axis, and put where an image may still be.
Eigen::Vector2d random_point_inside(const Distortion& lens, double share, std::mt19937_64& random);

}  // namespace penumbra::test
