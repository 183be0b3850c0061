// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <research/seed_run.hpp>

namespace penumbra::research {

/// A 95 % confidence interval, 2.5 % beyond either end.
struct Confidence {
  double low = 0, high = 0;
};

/// A method in one seed.
struct MethodOfSeed {
  const SeedRun* seed = nullptr;
  const MethodRun* method = nullptr;
};

/// What is measured of a method, over one seed or several.
struct Measure {
  std::string key;  ///< in metrics.json
  std::function<std::optional<double>(std::span<const MethodOfSeed>)> value;
};

[[nodiscard]] std::vector<Measure> measures_of(const std::string& experiment);

struct Interval {
  std::optional<double> value;           ///< over all seeds; empty if there was nothing to measure
  std::optional<Confidence> confidence;  ///< 95 %; empty for a single seed, or if all resamples are
                                         ///< the same
};

/// Returns the value below which the fraction `q` of `values` lies, interpolated; nothing if there
/// are no values.
[[nodiscard]] std::optional<double> quantile(std::vector<double> values, double q);

/// Returns the measure over all seeds. The bootstrap takes percentiles of 1000 resamples, always
/// the same ones.
[[nodiscard]] Interval interval_of(const Measure& measure, std::span<const MethodOfSeed> seeds);

/// Returns one method of one lane in every seed.
[[nodiscard]] std::vector<MethodOfSeed> method_of(const ExperimentResult& result, std::size_t lane,
                                                  std::size_t method);

}  // namespace penumbra::research
