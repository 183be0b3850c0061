// SPDX-License-Identifier: Apache-2.0
#include "timing.hpp"

#include <algorithm>
#include <fstream>

#include <penumbra/base/simd_target.hpp>
#include <penumbra/base/statistics-inl.hpp>

namespace penumbra::bench {
namespace {

double median_of(std::vector<double> values) { return detail::median(values); }

}  // namespace

void FrameTimes::add(std::size_t frame, double ms) {
  best_[frame] = std::min(best_[frame], ms);
  all_.push_back(ms);
}

double FrameTimes::median() const { return median_of(all_); }
double FrameTimes::typical() const { return median_of(best_); }

Arguments::Arguments(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--rounds") rounds = std::stoi(argv[i + 1]);
    if (name == "--json") json_file = argv[i + 1];
  }
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
