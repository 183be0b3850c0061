// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sim/experiments/confidence.hpp>
#include <sim/experiments/results.hpp>

namespace penumbra::sim {

/// A method's run and what was true meanwhile.
struct Watched {
  const SeedRun* seed = nullptr;
  const MethodRun* method = nullptr;
};

/// How a measure's confidence is found. A bootstrap says nothing of what never or always came out:
/// every resample is the same.
enum class Spread {
  resampled,  ///< a bootstrap over seeds
  count,      ///< events per seed: of fewer than 10 in all Poisson's exact interval
  seeds,      ///< percent of the seeds: Clopper's and Pearson's exact interval
  events      ///< percent of the events: where none or all, as if each seed were one event, since
              ///< those of one seed belong together
};

/// What is measured of a method: over one seed or several.
struct Measure {
  std::string key;   ///< in metrics.json
  std::string name;  ///< in the report
  std::string unit;  ///< mm, deg, s, %, or empty for a count
  int digits = 1;
  std::function<std::optional<double>(std::span<const Watched>)> value;
  Spread spread = Spread::resampled;
};

[[nodiscard]] std::vector<Measure> measures_of(const std::string& experiment);

struct Interval {
  std::optional<double> value;  ///< over all seeds; nothing where nothing was there to measure
  std::optional<Confidence> confidence;  ///< 95 %; nothing of a single seed, or where all resamples
                                         ///< are the same
};

/// The value that share `q` of `values` lies below, between the two nearest; nothing of nothing.
[[nodiscard]] std::optional<double> quantile(std::vector<double> values, double q);

/// The measure over all seeds. A bootstrap takes percentiles of 1000 resamples, always the same
/// ones.
[[nodiscard]] Interval interval_of(const Measure& measure, std::span<const Watched> seeds);

/// One method of one lane in every seed.
[[nodiscard]] std::vector<Watched> watched(const ExperimentResult& result, std::size_t lane,
                                           std::size_t method);

}  // namespace penumbra::sim
