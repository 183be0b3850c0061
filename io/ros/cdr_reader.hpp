// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace penumbra::io {

/// The bytes of a number in the other order.
template <typename T>
[[nodiscard]] T byte_swapped(T value) {
  if constexpr (sizeof(T) == 1) return value;
  if constexpr (sizeof(T) == 2) {
    const auto bits = std::bit_cast<std::uint16_t>(value);
    return std::bit_cast<T>(static_cast<std::uint16_t>(bits << 8U | bits >> 8U));
  }
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  std::reverse(bytes.begin(), bytes.end());
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

/// Reads a payload in CDR as ROS 2 writes it (OMG's XCDR version 1, plain: encapsulations CDR_BE
/// and CDR_LE; others are faults). Numbers are aligned to their own size, counted from after the
/// four bytes of encapsulation.
///
/// The first fault stays: from it on everything that is read is 0 or empty.
class CdrReader {
 public:
  static constexpr std::size_t header_bytes = 4;

  /// Refers to `payload` as long as it lives, and so does what is read.
  explicit CdrReader(std::span<const std::byte> payload);

  [[nodiscard]] bool ok() const { return reason_.empty(); }

  /// One line: where and what; empty if ok.
  [[nodiscard]] std::string fault() const;

  /// Says, from the inside to the outside, in which field the fault lies.
  void locate(const std::string& field);

  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }

  /// The payload's byte behind what was read last.
  [[nodiscard]] std::size_t at() const { return header_bytes + at_; }

  /// Of the payload's numbers, other than this machine's.
  [[nodiscard]] bool swaps() const { return swaps_; }

  template <typename T>
  [[nodiscard]] T read() {
    const std::byte* from = take(sizeof(T), sizeof(T));
    if (from == nullptr) return T{};
    T value;
    std::memcpy(&value, from, sizeof(T));
    return swaps_ ? byte_swapped(value) : value;
  }

  /// `count` numbers, which need not be aligned in memory.
  template <typename T>
  void read_array(T* to, std::size_t count) {
    const std::byte* from = take_array(count, sizeof(T));
    if (from == nullptr) {
      std::fill_n(to, count, T{});
      return;
    }
    std::memcpy(to, from, count * sizeof(T));
    if (swaps_) std::transform(to, to + count, to, byte_swapped<T>);
  }

  [[nodiscard]] bool read_bool();
  [[nodiscard]] std::string_view read_string();
  [[nodiscard]] std::span<const std::byte> read_octets(std::size_t count);

  /// The number of elements of a sequence, each of which takes `min_bytes` or more: a number that
  /// cannot be is a fault.
  [[nodiscard]] std::size_t read_count(std::size_t min_bytes);

  /// Sets a fault of what was read last, if there is none yet.
  void fail(std::string reason);

 private:
  const std::byte* take(std::size_t count, std::size_t alignment) {
    const std::size_t start = (at_ + alignment - 1) & ~(alignment - 1);
    if (start > bytes_.size() || count > bytes_.size() - start) {
      fail_short(count);
      return nullptr;
    }
    at_ = start + count;
    return bytes_.data() + start;
  }

  // Without elements there is no alignment either.
  const std::byte* take_array(std::size_t count, std::size_t size) {
    if (count == 0) return nullptr;
    if (count > remaining() / size) {
      fail_short(count);
      return nullptr;
    }
    return take(count * size, size);
  }

  void fail_short(std::size_t count);

  std::span<const std::byte> bytes_;  // after the encapsulation
  std::size_t at_ = 0;
  bool swaps_ = false;
  std::size_t fault_at_ = 0;
  std::string reason_;
  std::string path_;
};

}  // namespace penumbra::io
