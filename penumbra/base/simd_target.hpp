// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Names of the SIMD targets that this build has and this machine runs, best first. The names are
/// Highway's ("AVX3", "AVX2", "SSE4", ...).
[[nodiscard]] std::vector<std::string> simd_target_names();

/// Highway's bit of the named target; of the best one if the name is empty. Throws InputError, with
/// the names that are there, for any other name.
[[nodiscard]] std::int64_t simd_target(std::string_view name);

/// Highway's name of a target's bit.
[[nodiscard]] std::string simd_target_name(std::int64_t target);

}  // namespace penumbra
