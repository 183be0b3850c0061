// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace penumbra::io {

/// A histogram of durations with bins of 2 %. Its size does not grow with the number of durations.
class LatencyHistogram {
 public:
  void add(double milliseconds) {
    const double bin = std::log(std::max(milliseconds, least) / least) / std::log(step);
    ++bins_[std::min(static_cast<std::size_t>(bin), bins_.size() - 1)];
    ++count_;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Returns the duration in milliseconds that the fraction `share` of the durations does not
  /// exceed, or nothing if there are no durations.
  [[nodiscard]] std::optional<double> quantile(double share) const {
    if (count_ == 0) return std::nullopt;
    const auto wanted = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count_)));
    std::size_t seen = 0, bin = 0;
    for (; bin + 1 < bins_.size(); ++bin) {
      seen += bins_[bin];
      if (seen >= std::max<std::size_t>(wanted, 1)) break;
    }
    return least * std::pow(step, static_cast<double>(bin) + 0.5);
  }

  void clear() { *this = {}; }

 private:
  static constexpr double least = 0.01;  // milliseconds
  static constexpr double step = 1.02;
  std::array<std::size_t, 1000> bins_{};  // up to 4e6 ms
  std::size_t count_ = 0;
};

}  // namespace penumbra::io
