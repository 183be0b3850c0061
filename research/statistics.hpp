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

/// How a measure's confidence is found. A bootstrap says nothing of an event that happened never or
/// always: every resample is the same.
enum class Spread {
  resampled,  ///< a bootstrap over seeds
  count,      ///< events per seed: Poisson's exact interval if there are fewer than 10 in all
  seeds,      ///< percent of the seeds: Clopper's and Pearson's exact interval
  events      ///< percent of the events: if it is 0 or 100, as if each seed were one event, because
              ///< the events of one seed depend on each other
};

/// What is measured of a method, over one seed or several.
struct Measure {
  std::string key;  ///< in metrics.json
  std::function<std::optional<double>(std::span<const MethodOfSeed>)> value;
  Spread spread = Spread::resampled;
};

[[nodiscard]] std::vector<Measure> measures_of(const std::string& experiment);

struct Interval {
  std::optional<double> value;           ///< over all seeds; empty if there was nothing to measure
  std::optional<Confidence> confidence;  ///< 95 %; empty for a single seed, or if all resamples are
                                         ///< the same
};

/// Returns the exact interval of the expected number of events if `count` were seen (Garwood 1936).
[[nodiscard]] Confidence count_confidence(std::size_t count);

/// Returns the exact interval of the probability if `count` of `all` trials succeeded (Clopper and
/// Pearson 1934). all > 0.
[[nodiscard]] Confidence fraction_confidence(std::size_t count, std::size_t all);

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
