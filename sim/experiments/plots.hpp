// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sim/experiments/results.hpp>
#include <sim/experiments/statistics.hpp>

namespace penumbra::sim {

/// The colour and dash pattern of a method's line: Okabe and Ito's palette, told apart with any
/// common colour blindness.
struct LineStyle {
  const char* color;
  const char* dash;
};
[[nodiscard]] LineStyle line_style(const std::string& key);

/// Position error of every method against time, on a logarithmic scale, as SVG; spans in which the
/// target is hidden are shaded, the goal is marked.
[[nodiscard]] std::string error_plot(const SeedRun& run, std::size_t lane,
                                     std::string_view goal_name);

/// Values with their confidence as dots and whiskers, one row per method, as SVG. All > 0.
[[nodiscard]] std::string interval_chart(const std::vector<MethodInfo>& methods,
                                         const std::vector<Interval>& intervals,
                                         std::string_view title);

}  // namespace penumbra::sim
