// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace penumbra::sim {

/// What holds a value with 95 % confidence, 2.5 % beyond either end.
struct Confidence {
  double low = 0, high = 0;
};

/// Of the expected number of events where `count` were seen, exact (Garwood 1936).
[[nodiscard]] Confidence count_confidence(std::size_t count);

/// Of the probability where `count` of `all` came out, exact (Clopper and Pearson 1934). all > 0.
[[nodiscard]] Confidence share_confidence(std::size_t count, std::size_t all);

}  // namespace penumbra::sim
