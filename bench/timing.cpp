// SPDX-License-Identifier: Apache-2.0
#include "timing.hpp"

#include <algorithm>
#include <fstream>

namespace penumbra::bench {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void FrameTimes::add(std::size_t frame, double ms) {
  best_[frame] = std::min(best_[frame], ms);
  all_.push_back(ms);
}

double FrameTimes::median() const { return median_of(all_); }
double FrameTimes::min() const { return *std::min_element(all_.begin(), all_.end()); }
double FrameTimes::typical() const { return median_of(best_); }

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

}  // namespace penumbra::bench
