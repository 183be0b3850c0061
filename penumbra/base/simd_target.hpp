// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Returns Highway's names ("AVX3", "AVX2", "SSE4", ...) of the SIMD targets of this build that run
/// on this machine, the best first.
[[nodiscard]] std::vector<std::string> simd_target_names();

/// Returns Highway's bit of the named target, or of the best one if the name is empty. Throws
/// InputError, with the available names, for any other name.
[[nodiscard]] std::int64_t simd_target(std::string_view name);

/// Returns Highway's name of a target's bit.
[[nodiscard]] std::string simd_target_name(std::int64_t target);

}  // namespace penumbra
