// SPDX-License-Identifier: Apache-2.0
// How long a test takes: all samples, fewer under sanitizers, more with PENUMBRA_FULL.
#pragma once

#include <cstdlib>

namespace penumbra::test {

/// Whether this build watches memory or threads (PENUMBRA_SANITIZE), which takes memory of its own
/// and 20 times as long.
inline constexpr bool sanitized = PENUMBRA_IS_SANITIZED;

/// Sanitizers see what code does after a few samples; how exact its results are is for other builds
/// to measure, with all samples.
inline constexpr int sample_stride = sanitized ? 5 : 1;
constexpr int samples(int all) { return all / sample_stride; }

/// Whether the long searches for faults are asked for.
inline bool is_full_run() { return std::getenv("PENUMBRA_FULL") != nullptr; }

/// Whether the long measurements are: they are no sanitizer's, which sees no more in them than in
/// short ones.
inline bool measures_in_full() { return is_full_run() && !sanitized; }

}  // namespace penumbra::test
