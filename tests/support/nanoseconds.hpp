// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace penumbra::test {

inline constexpr std::int64_t ms = 1'000'000;

}  // namespace penumbra::test
