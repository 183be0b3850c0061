// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <io/ros/cdr_reader.hpp>

namespace penumbra::io {

/// Writes payloads that CdrReader reads.
class CdrWriter {
 public:
  /// Replaces the content of `bytes` by the start of a payload.
  explicit CdrWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {
    bytes_.assign(CdrReader::header_bytes, std::byte{0});
    bytes_[1] = std::byte{1};  // little endian
  }

  template <typename T>
  void write(T value) {
    align(sizeof(T));
    append(&value, sizeof(T));
  }

  /// Writes `count` numbers. An empty array is not aligned.
  template <typename T>
  void write_array(const T* from, std::size_t count) {
    if (count == 0) return;
    align(sizeof(T));
    append(from, count * sizeof(T));
  }

  void write_bool(bool value) { write(static_cast<std::uint8_t>(value ? 1 : 0)); }

  void write_string(std::string_view text) {
    write_count(text.size() + 1);
    append(text.data(), text.size());
    bytes_.push_back(std::byte{0});
  }

  /// Throws std::length_error for more than 2^32 - 1.
  void write_count(std::size_t count) {
    if (count > std::numeric_limits<std::uint32_t>::max())
      throw std::length_error("CDR counts up to 2^32 - 1");
    write(static_cast<std::uint32_t>(count));
  }

 private:
  void align(std::size_t alignment) {
    const std::size_t at = bytes_.size() - CdrReader::header_bytes;
    bytes_.resize(bytes_.size() + (alignment - at % alignment) % alignment);
  }

  void append(const void* from, std::size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), first, first + count);
  }

  std::vector<std::byte>& bytes_;
};

}  // namespace penumbra::io
