// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/base/image.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra::test {

using Corners = std::vector<Vector2d>;

/// What geometry says of a pixel's centre; `close`: rounding may decide.
enum class Place { outside, inside, close };

inline constexpr double close_pixels = 1e-7;  // far above rounding, far below a pixel

inline double distance_to(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

/// By the sum of the angles under which the edges are seen, full turns of either sign.
inline Place place_in_polygon(const Corners& corners, const Vector2d& p) {
  double angle = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& a = corners[i];
    const Vector2d& b = corners[(i + 1) % corners.size()];
    if (distance_to(a, b, p) < close_pixels) return Place::close;
    const Vector2d x = a - p, y = b - p;
    angle += std::atan2(x.x() * y.y() - x.y() * y.x(), x.dot(y));
  }
  return std::abs(angle) > std::numbers::pi ? Place::inside : Place::outside;
}

inline Place place_in_ellipse(const PixelEllipse& ellipse, const Vector2d& p) {
  const Vector2d d = p - ellipse.centre;
  const double c = std::cos(ellipse.angle), s = std::sin(ellipse.angle);
  const double r = std::hypot((c * d.x() + s * d.y()) / ellipse.semi_axes.x(),
                              (c * d.y() - s * d.x()) / ellipse.semi_axes.y());
  if (std::abs(r - 1) < close_pixels) return Place::close;
  return r < 1 ? Place::inside : Place::outside;
}

/// How far the number of pixels in an ellipse can be from its area: half the length of a convex
/// outline and 1 (Nosarzewska 1948), and half a pixel that rounding adds. 0 if all of the ellipse
/// lies in the image: then its pixels are counted.
inline double area_error(const PixelEllipse& ellipse, int width, int height) {
  const double c = std::cos(ellipse.angle), s = std::sin(ellipse.angle);
  const double a = ellipse.semi_axes.x(), b = ellipse.semi_axes.y();
  const Eigen::Array2d reach(std::hypot(a * c, b * s), std::hypot(a * s, b * c));
  const Eigen::Array2d low = ellipse.centre.array() - reach, high = ellipse.centre.array() + reach;
  if (low.minCoeff() >= 0 && high.x() <= width - 1 && high.y() <= height - 1) return 0;
  const double longest_outline = std::numbers::pi * std::sqrt(2 * (a * a + b * b));
  return longest_outline / 2 + 1.5;
}

inline Place place_in_box(const PixelBox& box, const Vector2d& p) {
  const bool inside =
      box.u <= p.x() && p.x() < box.u + box.width && box.v <= p.y() && p.y() < box.v + box.height;
  return inside ? Place::inside : Place::outside;
}

/// A polygon around a point of which all of its outline is seen, so that no edges cross.
inline Corners random_star(std::mt19937_64& random, const Vector2d& centre, double radius,
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
inline std::vector<std::uint32_t> run_lengths(ImageView<const std::uint8_t> mask) {
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

}  // namespace penumbra::test
