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

  /// Median over the frames of each frame's fastest round: what a frame costs where other programs
  /// do not disturb it.
  [[nodiscard]] double typical() const;

 private:
  std::vector<double> best_;
  std::vector<double> all_;
};

/// The arguments [--rounds N] [--json FILE] of a benchmark.
struct Arguments {
  Arguments(int argc, char** argv);

  int rounds = 5;
  std::string json_file;
};

/// The processor's name and model number.
[[nodiscard]] std::string cpu_model();

/// The SIMD targets that are compared: the best one, and AVX2 if that is another.
[[nodiscard]] std::vector<std::string> compared_isas();

}  // namespace penumbra::bench
