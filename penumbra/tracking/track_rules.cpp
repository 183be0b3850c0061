// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/tracking/gaussian-inl.hpp>
#include <penumbra/tracking/track_rules-inl.hpp>
#include <penumbra/tracking/trackers.hpp>

namespace penumbra::detail {
namespace {

template <class Value>
[[noreturn]] void refuse_field(std::string_view config, std::string_view field, const Value& value,
                               std::string_view right) {
  std::ostringstream message;
  message << config << ": " << field << " is " << value << "; " << right;
  throw InputError(message.str());
}

bool is_known_verdict(Verdict verdict) {
  return verdict == Verdict::visible || verdict == Verdict::partial || verdict == Verdict::hidden;
}

}  // namespace

void require_positive(std::string_view config, std::string_view field, double value) {
  if (!(value >= least_sigma && value <= greatest_sigma)) {
    refuse_field(config, field, value, "it must be > 0 (1e-9 to 1e9)");
  }
}

void require_not_negative(std::string_view config, std::string_view field, double value) {
  if (!(value >= 0 && value <= greatest_sigma)) {
    refuse_field(config, field, value, "it must be >= 0 (and at most 1e9)");
  }
}

void check_rules(std::string_view config, const TrackRules& rules) {
  require_positive(config, "timeout", rules.timeout);
  require_positive(config, "gate", rules.gate);
  require_not_negative(config, "memory", rules.memory);
  if (rules.gate_patience < 1) {
    refuse_field(config, "gate_patience", rules.gate_patience, "it must be at least 1");
  }
  if (rules.max_estimates < 2) {
    refuse_field(config, "max_estimates", rules.max_estimates, "it must be at least 2");
  }
  if (!is_known_verdict(rules.worst)) {
    refuse_field(config, "worst", to_string(rules.worst), "it must be visible, partial or hidden");
  }
}

bool good_enough(Verdict verdict, Verdict worst) {
  return is_known_verdict(verdict) && verdict <= worst;
}

}  // namespace penumbra::detail

namespace penumbra {

std::string_view to_string(Source source) {
  constexpr std::array<std::string_view, 4> names = {"measured", "predicted", "held", "lost"};
  return names[static_cast<std::size_t>(source)];
}

std::string_view to_string(Outcome outcome) {
  constexpr std::array<std::string_view, 5> names = {"accepted", "refused_verdict", "refused_gate",
                                                     "refused_late", "refused_invalid"};
  return names[static_cast<std::size_t>(outcome)];
}

}  // namespace penumbra
