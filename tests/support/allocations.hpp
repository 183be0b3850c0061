// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace penumbra::test {

/// Returns how often the program has called operator new. Link penumbra_counted_allocations into
/// the test.
[[nodiscard]] std::size_t allocations();

/// During its lifetime, the first `spared` allocations of `large` bytes or more succeed and later
/// ones throw std::bad_alloc. Only one may exist at a time.
class MemoryShortage {
 public:
  MemoryShortage(std::size_t large, std::size_t spared);
  ~MemoryShortage();
  MemoryShortage(const MemoryShortage&) = delete;
  MemoryShortage& operator=(const MemoryShortage&) = delete;

  /// Allocations of `large` bytes or more so far.
  [[nodiscard]] std::size_t asked() const;
};

}  // namespace penumbra::test
