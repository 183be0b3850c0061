// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace penumbra::test {

/// How often the program has called operator new. Link allocations.cpp into the test.
[[nodiscard]] std::size_t allocations();

}  // namespace penumbra::test
