// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::test {

/// Whether this build watches memory or threads (PENUMBRA_SANITIZE), which takes memory of its own
/// and 20 times as long.
inline constexpr bool sanitized = PENUMBRA_IS_SANITIZED;

/// Sanitizers see what code does after a few samples; how exact its results are is for other builds
/// to measure, with all samples.
inline constexpr int sample_stride = sanitized ? 5 : 1;
constexpr int samples(int all) { return all / sample_stride; }

}  // namespace penumbra::test
