// SPDX-License-Identifier: Apache-2.0
#include "sensor.hpp"

#include <algorithm>
#include <cmath>

namespace example {
namespace {

constexpr double focal_baseline = View::fx * View::baseline;  // pixels x metres
constexpr double disparity_step = 1.0 / 16.0;                 // pixels
constexpr double disparity_noise = 0.08;                      // pixels, standard deviation
constexpr double border_wander = 1.1;                         // pixels, standard deviation
constexpr double farthest = 4.0;                              // metres
constexpr double edge = 0.03;     // relative depth step that counts as an edge
constexpr double grazing = 0.15;  // cosine
constexpr double blob = 2.45;     // standard deviations

/// Independent fields of noise.
enum Field : std::uint64_t { wander_u, wander_v, patches, grain, chance, blend, blobs };

/// Numbers that depend on nothing but their arguments, so that threads and order do not matter.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : seed_(seed) {}

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform(Field field, int u, int v, std::uint64_t k = 0) const {
    std::uint64_t x = mix(seed_ ^ (field * 0x9E3779B97F4A7C15ULL));
    x = mix(x ^ (static_cast<std::uint64_t>(u) << 32) ^ static_cast<std::uint32_t>(v));
    return static_cast<double>(mix(x + k) >> 11) * 0x1p-53;
  }

  /// About normal (Irwin-Hall of twelve), mean 0 and variance 1.
  [[nodiscard]] double normal(Field field, int u, int v) const {
    double sum = -6.0;
    for (std::uint64_t k = 0; k < 12; ++k) sum += uniform(field, u, v, k);
    return sum;
  }

  /// The same, but smooth over `cell` pixels. Variance about 0.5 at worst, between lattice points.
  [[nodiscard]] double smooth(Field field, int u, int v, int cell) const {
    const int i = u / cell, j = v / cell;
    const double s = ease(static_cast<double>(u % cell) / cell);
    const double t = ease(static_cast<double>(v % cell) / cell);
    return std::lerp(std::lerp(normal(field, i, j), normal(field, i + 1, j), s),
                     std::lerp(normal(field, i, j + 1), normal(field, i + 1, j + 1), s), t);
  }

 private:
  static double ease(double x) { return x * x * (3.0 - 2.0 * x); }

  /// The finalizer of splitmix64 (Steele, Lea and Flood 2014).
  static std::uint64_t mix(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31);
  }

  std::uint64_t seed_;
};

std::size_t index(int u, int v) {
  return static_cast<std::size_t>(std::clamp(v, 0, View::height - 1)) * View::width +
         static_cast<std::size_t>(std::clamp(u, 0, View::width - 1));
}

/// The depth that the matching window at (u, v) settles on; 0 where it fails.
double matched_depth(const Truth& truth, const Noise& noise, int u, int v) {
  const int su = u + static_cast<int>(std::lround(border_wander * noise.smooth(wander_u, u, v, 5)));
  const int sv = v + static_cast<int>(std::lround(border_wander * noise.smooth(wander_v, u, v, 5)));
  const std::size_t source = index(su, sv);
  double near = truth.depth[source], far = near;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) {
      near = std::min(near, truth.depth[index(su + du, sv + dv)]);
      far = std::max(far, truth.depth[index(su + du, sv + dv)]);
    }
  const double luck = noise.uniform(chance, u, v);
  if (truth.shade[source] != 0 && luck < 0.92) return 0.0;
  if (truth.facing[source] < grazing && luck < 0.6) return 0.0;
  if (noise.smooth(blobs, u, v, 11) > blob) return 0.0;
  if (far > near * (1.0 + edge)) {
    if (luck < 0.40) return 0.0;
    if (luck < 0.65) return 1.0 / std::lerp(1.0 / near, 1.0 / far, noise.uniform(blend, u, v));
  }
  return truth.depth[source];
}

}  // namespace

std::vector<std::uint16_t> measure(const Truth& truth, std::uint64_t seed) {
  const Noise noise(seed);
  std::vector<std::uint16_t> depth(truth.depth.size());
  for (int v = 0; v < View::height; ++v)
    for (int u = 0; u < View::width; ++u) {
      const double z = matched_depth(truth, noise, u, v);
      if (!(z > 0.0 && z < farthest)) continue;
      const double error = disparity_noise * (1.1 * noise.smooth(patches, u, v, 8) +
                                              0.12 * noise.normal(grain, u, v));
      const double disparity =
          disparity_step * std::round((focal_baseline / z + error) / disparity_step);
      depth[index(u, v)] =
          static_cast<std::uint16_t>(std::lround(1000.0 * focal_baseline / disparity));
    }
  return depth;
}

}  // namespace example
