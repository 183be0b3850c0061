// SPDX-License-Identifier: Apache-2.0
#include "allocations.hpp"

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> count{0};
std::atomic<std::size_t> large{SIZE_MAX};  // bytes
std::atomic<std::size_t> large_count{0};
std::atomic<std::size_t> large_spared{0};

void take_note_of(std::size_t size) {
  ++count;
  if (size >= large && ++large_count > large_spared) throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
  take_note_of(size);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  take_note_of(size);
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace penumbra::test {

std::size_t allocations() { return count; }

MemoryShortage::MemoryShortage(std::size_t bytes, std::size_t spared) {
  large_count = 0;
  large_spared = spared;
  large = bytes;
}

MemoryShortage::~MemoryShortage() { large = SIZE_MAX; }

std::size_t MemoryShortage::asked() const { return large_count; }

}  // namespace penumbra::test
