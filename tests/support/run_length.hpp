// SPDX-License-Identifier: Apache-2.0
// How long a test takes: all samples, fewer under sanitizers, more with PENUMBRA_FULL.
#pragma once

#include <cstdlib>

namespace penumbra::test {

/// Whether this is a sanitizer build (PENUMBRA_SANITIZE), which needs more memory and 20 times as
/// long.
inline constexpr bool sanitized = PENUMBRA_IS_SANITIZED;

/// A few samples are enough for sanitizers. Other builds measure accuracy, with all samples.
inline constexpr int sample_stride = sanitized ? 5 : 1;
constexpr int samples(int all) { return all / sample_stride; }

/// Whether PENUMBRA_FULL asks for the long fault searches.
inline bool is_full_run() { return std::getenv("PENUMBRA_FULL") != nullptr; }

/// Whether PENUMBRA_FULL asks for the long measurements. Sanitizer builds skip them.
inline bool measures_in_full() { return is_full_run() && !sanitized; }

}  // namespace penumbra::test
