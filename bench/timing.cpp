// SPDX-License-Identifier: Apache-2.0
#include "timing.hpp"

#include <algorithm>
#include <ctime>
#include <fstream>

#include <penumbra/base/simd_target.hpp>

namespace penumbra::bench {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double clock_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Applies `f` to each figure's values.
template <typename F>
PassCost by_figure(const std::vector<PassCost>& costs, F&& f) {
  const auto of = [&](double PassCost::*figure) {
    std::vector<double> values;
    values.reserve(costs.size());
    for (const PassCost& cost : costs) values.push_back(cost.*figure);
    return f(values);
  };
  return {of(&PassCost::wall_ms), of(&PassCost::process_ms), of(&PassCost::thread_ms)};
}

}  // namespace

void FrameTimes::add(std::size_t frame, double ms) {
  best_[frame] = std::min(best_[frame], ms);
  all_.push_back(ms);
}

double FrameTimes::median() const { return median_of(all_); }
double FrameTimes::min() const { return *std::min_element(all_.begin(), all_.end()); }
double FrameTimes::typical() const { return median_of(best_); }

PassCost clocks_now() {
  return {clock_ms(CLOCK_MONOTONIC), clock_ms(CLOCK_PROCESS_CPUTIME_ID),
          clock_ms(CLOCK_THREAD_CPUTIME_ID)};
}

PassCost PassCosts::least() const {
  return by_figure(all_, [](const auto& v) { return *std::min_element(v.begin(), v.end()); });
}

PassCost PassCosts::median() const {
  return by_figure(all_, [](const auto& v) { return median_of(v); });
}

void CacheSweeper::sweep() {
  constexpr std::size_t cache_line = 64;
  for (std::size_t i = 0; i < memory_.size(); i += cache_line) memory_[i] = next_;
  ++next_;
}

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  std::string line;
  std::string model;
  while (std::getline(cpuinfo, line)) {
    const auto value = [&line] { return line.substr(line.find(':') + 2); };
    if (line.starts_with("model name")) return value() + ", " + model;
    if (line.starts_with("cpu family")) model = "family " + value();
    if (line.starts_with("model\t")) model += " model " + value();
  }
  return "unknown";
}

std::vector<std::string> compared_isas() {
  std::vector<std::string> chosen{simd_target_names().front()};
  for (const std::string& isa : simd_target_names()) {
    if (isa == "AVX2" && isa != chosen.front()) chosen.push_back(isa);
  }
  return chosen;
}

}  // namespace penumbra::bench
