// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <penumbra/base/error.hpp>

namespace penumbra {

/// Returns the nanoseconds between any two stamps.
[[nodiscard]] inline std::uint64_t stamp_distance(std::int64_t a, std::int64_t b) {
  const auto x = static_cast<std::uint64_t>(std::max(a, b));
  return x - static_cast<std::uint64_t>(std::min(a, b));
}

/// Messages may arrive out of order by at most this many nanoseconds. A stamp further before the
/// newest one means that the clock was set back, as in a bag that is played in a loop.
inline constexpr std::int64_t least_clock_jump = 1'000'000'000;

[[nodiscard]] inline bool is_clock_jump(std::int64_t stamp, std::int64_t newest) {
  return stamp < newest && stamp_distance(stamp, newest) > std::uint64_t{least_clock_jump};
}

/// Returns the position of a stamp between two others, 0 to 1.
[[nodiscard]] inline double stamp_share(std::int64_t before, std::int64_t stamp,
                                        std::int64_t after) {
  return static_cast<double>(stamp_distance(before, stamp)) /
         static_cast<double>(stamp_distance(before, after));
}

/// Returns the stamp `by` nanoseconds later, saturated.
[[nodiscard]] inline std::int64_t stamp_after(std::int64_t stamp, std::int64_t by) {
  using Limits = std::numeric_limits<std::int64_t>;
  if (by > 0 && stamp > Limits::max() - by) return Limits::max();
  if (by < 0 && stamp < Limits::min() - by) return Limits::min();
  return stamp + by;
}

/// Converts a user's time span, called `name` in messages, to nanoseconds. Throws InputError unless
/// it is from `least` to 1e9 seconds.
[[nodiscard]] inline std::int64_t span_nanoseconds(double seconds, const std::string& name,
                                                   double least = 0.0) {
  constexpr double longest = 1e9;  // seconds; far below the range of nanoseconds
  if (!(seconds >= least && seconds <= longest))
    throw InputError(name + " is " + std::to_string(seconds) + " s; expected a time from " +
                     (least == 0.0 ? "0" : "-1e9") + " to 1e9 s");
  return std::llround(seconds * 1e9);
}

}  // namespace penumbra
