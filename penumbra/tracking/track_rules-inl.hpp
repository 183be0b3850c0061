// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include <penumbra/targets/target.hpp>

namespace penumbra::detail {

/// The rules of all trackers.
struct TrackRules {
  double timeout = 0;             ///< seconds
  double gate = 0;                ///< squared Mahalanobis distance
  std::size_t gate_patience = 0;  ///< consistent outliers in a row that make a new track
  double memory = 0;              ///< seconds
  std::size_t max_estimates = 0;  ///< that are remembered
  Verdict worst = Verdict::visible;
};

[[nodiscard]] constexpr Verdict worst_of(std::optional<Verdict> worst) {
  return worst.value_or(Verdict::visible);
}

/// Returns the rules in a tracker's configuration, whose fields have the same names.
template <class Config>
TrackRules rules_of(const Config& config) {
  return {config.timeout, config.gate,          config.gate_patience,
          config.memory,  config.max_estimates, worst_of(config.worst)};
}

/// Throw InputError: "NAME: FIELD is VALUE; what is expected".
void check_rules(std::string_view config, const TrackRules& rules);
void require_positive(std::string_view config, std::string_view field, double value);
void require_not_negative(std::string_view config, std::string_view field, double value);

/// Returns whether estimates with this verdict are accepted. Others than visible, partial
/// and hidden never are.
[[nodiscard]] bool good_enough(Verdict verdict, Verdict worst);

}  // namespace penumbra::detail
