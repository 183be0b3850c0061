// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace penumbra::bench {

/// Wall-clock milliseconds of one call.
template <typename F>
double time_ms(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  return took.count();
}

/// Times of the same frames in several rounds.
class FrameTimes {
 public:
  explicit FrameTimes(std::size_t frames) : best_(frames, 1e300) {}

  void add(std::size_t frame, double ms);

  [[nodiscard]] double median() const;  ///< of all calls
  [[nodiscard]] double min() const;     ///< of all calls

  /// Median over the frames of each frame's fastest round: what a frame costs where other programs
  /// do not disturb it.
  [[nodiscard]] double typical() const;

 private:
  std::vector<double> best_;
  std::vector<double> all_;
};

/// Fills every cache with other data.
class CacheSweeper {
 public:
  void sweep();

 private:
  static constexpr std::size_t bytes = std::size_t{96} << 20;
  std::vector<char> memory_ = std::vector<char>(bytes);
  char next_ = 1;
};

/// The processor's name and number, as the kernel tells it.
[[nodiscard]] std::string cpu_model();

}  // namespace penumbra::bench
