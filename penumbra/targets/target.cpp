// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <penumbra/targets/region_spans-inl.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

void TargetThresholds::check() const {
  const auto check_share = [](const char* name, double value) {
    if (!(value >= 0 && value <= 1)) region_fault(name, ' ', value, ": must be 0 to 1");
  };
  check_share("partial_enter", partial_enter);
  check_share("partial_leave", partial_leave);
  check_share("hidden_enter", hidden_enter);
  check_share("hidden_leave", hidden_leave);
  if (unknown_limit) check_share("unknown_limit", *unknown_limit);
  check_share("past_limit", past_limit);
  check_share("min_measured", min_measured);
  check_share("min_inside", min_inside);
  check_share("point_min_fraction", point_min_fraction);
  const auto check_order = [](const char* low_name, double low, const char* high_name,
                              double high) {
    if (low > high) region_fault(low_name, ' ', low, ": must not exceed ", high_name, ' ', high);
  };
  check_order("partial_leave", partial_leave, "partial_enter", partial_enter);
  check_order("hidden_leave", hidden_leave, "hidden_enter", hidden_enter);
  check_order("partial_enter", partial_enter, "hidden_enter", hidden_enter);
  check_order("partial_leave", partial_leave, "hidden_leave", hidden_leave);
}

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 6> names = {"visible", "partial",     "hidden",
                                                     "unknown", "out_of_view", "held"};
  return names[static_cast<std::size_t>(verdict)];
}

}  // namespace penumbra
