// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace penumbra::sim {

/// Mixes bits by the finalizer of splitmix64 (Steele, Lea and Flood 2014).
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// A random generator with the same numbers for every standard library.
class Random {
 public:
  /// `stream` selects one of the independent sequences of a seed.
  Random(std::uint64_t seed, std::uint64_t stream)
      : state_(mix(seed) ^ mix(~stream * 0xD1342543DE82EF95ULL)) {}

  [[nodiscard]] std::uint64_t bits() { return mix(state_ += 0x9E3779B97F4A7C15ULL); }

  /// Returns a uniform number in [low, high).
  [[nodiscard]] double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }

  /// Returns -1 or 1.
  [[nodiscard]] double sign() { return (bits() & 1U) != 0 ? 1.0 : -1.0; }

  /// Returns a normal number with mean 0 and variance 1 (Box and Muller 1958).
  [[nodiscard]] double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace penumbra::sim
