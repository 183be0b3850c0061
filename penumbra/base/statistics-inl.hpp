// SPDX-License-Identifier: Apache-2.0
// Order statistics and weights that outliers do not spoil.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace penumbra::detail {

/// Returns the value that `rank` others are not larger than; 0 without values. Reorders the values.
template <typename T>
[[nodiscard]] T ranked(std::vector<T>& values, std::size_t rank) {
  if (values.empty()) return T{0};
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Returns the smallest value that at least a fraction of all do not exceed. Otherwise as ranked().
template <typename T>
[[nodiscard]] T quantile(std::vector<T>& values, double fraction) {
  constexpr double rounding = 1e-9;  // of a product that is a whole number
  const double count = std::ceil(fraction * static_cast<double>(values.size()) - rounding);
  return ranked(values, static_cast<std::size_t>(std::max(count, 1.0)) - 1);
}

/// Returns the middle value, the larger one of two. Otherwise as ranked().
template <typename T>
[[nodiscard]] T median(std::vector<T>& values) {
  return ranked(values, values.size() / 2);
}

/// The standard deviation of normal errors as a multiple of the median of their absolute values.
inline constexpr double normal_sigma = 1.4826;

/// Returns the standard deviation of normal errors from their absolute values. Otherwise as
/// ranked().
template <typename T>
[[nodiscard]] double robust_sigma(std::vector<T>& sizes) {
  return normal_sigma * static_cast<double>(median(sizes));
}

/// Sigmas at which Tukey's weight is 0; 95 % efficient for normal residuals.
inline constexpr double tukey_width = 4.685;

/// Returns Tukey's biweight of a residual, which is 0 at and beyond `limit`.
[[nodiscard]] inline double tukey_weight(double residual, double limit) {
  const double x = residual / limit;
  return std::abs(x) >= 1.0 ? 0.0 : (1.0 - x * x) * (1.0 - x * x);
}

}  // namespace penumbra::detail
