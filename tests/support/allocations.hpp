// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace penumbra::test {

/// How often the program has called operator new. Link penumbra_counted_allocations into the test.
[[nodiscard]] std::size_t allocations();

/// While one lives, memory of `large` bytes or more is given `spared` times and then refused with
/// std::bad_alloc. One at a time.
class MemoryShortage {
 public:
  MemoryShortage(std::size_t large, std::size_t spared);
  ~MemoryShortage();
  MemoryShortage(const MemoryShortage&) = delete;
  MemoryShortage& operator=(const MemoryShortage&) = delete;

  /// How often so much was asked for.
  [[nodiscard]] std::size_t asked() const;
};

}  // namespace penumbra::test
