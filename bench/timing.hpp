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

/// A pass over frames, in milliseconds per frame.
struct PassCost {
  double wall_ms;
  double process_ms;  ///< CPU time of the whole process: a driver's threads count
  double thread_ms;   ///< CPU time of the calling thread
};

/// The clocks' readings, of which a pass is a difference.
[[nodiscard]] PassCost clocks_now();

/// What `pass` costs, which draws that many frames.
template <typename F>
PassCost cost_of_pass(std::size_t frames, F&& pass) {
  const PassCost start = clocks_now();
  pass();
  const PassCost end = clocks_now();
  const auto n = static_cast<double>(frames);
  return {(end.wall_ms - start.wall_ms) / n, (end.process_ms - start.process_ms) / n,
          (end.thread_ms - start.thread_ms) / n};
}

/// The same pass in several rounds, each figure by itself.
class PassCosts {
 public:
  void add(const PassCost& cost) { all_.push_back(cost); }

  [[nodiscard]] PassCost least() const;
  [[nodiscard]] PassCost median() const;

 private:
  std::vector<PassCost> all_;
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

/// SIMD targets that are compared: the best one, and AVX2 where that is another.
[[nodiscard]] std::vector<std::string> compared_isas();

}  // namespace penumbra::bench
