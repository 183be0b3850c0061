// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

namespace penumbra::io::mcap {

/// A buffer of uninitialised bytes that keeps its memory when it is reused.
class ByteBuffer {
 public:
  ByteBuffer() = default;
  ByteBuffer(ByteBuffer&& other) noexcept
      : memory_(std::move(other.memory_)),
        capacity_(std::exchange(other.capacity_, 0)),
        size_(std::exchange(other.size_, 0)) {}
  ByteBuffer& operator=(ByteBuffer&& other) noexcept {
    memory_ = std::move(other.memory_);
    capacity_ = std::exchange(other.capacity_, 0);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }
  ~ByteBuffer() = default;

  [[nodiscard]] std::byte* data() { return memory_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  [[nodiscard]] std::span<const std::byte> view() const { return {memory_.get(), size_}; }

  /// Makes room for at least `count` bytes and keeps the first size() bytes.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    if (size_ == 0) memory_.reset();  // frees the old memory first
    auto larger = std::make_unique_for_overwrite<std::byte[]>(count);
    if (size_ > 0) std::copy_n(memory_.get(), size_, larger.get());
    memory_ = std::move(larger);
    capacity_ = count;
  }

  /// Changes the size. New bytes are uninitialised.
  void resize(std::size_t count) {
    reserve(count);
    size_ = count;
  }

 private:
  std::unique_ptr<std::byte[]> memory_;
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
};

}  // namespace penumbra::io::mcap
