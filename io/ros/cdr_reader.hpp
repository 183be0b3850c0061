// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace penumbra::io {

static_assert(std::endian::native == std::endian::little, "numbers are copied unchanged");

/// Reads a payload in CDR as ROS 2 writes it (OMG's plain XCDR version 1, little endian; other
/// encapsulations are faults). Numbers are aligned to their own size, counted from after the four
/// bytes of encapsulation. After the first fault every value is 0 or empty.
class CdrReader {
 public:
  static constexpr std::size_t header_bytes = 4;

  /// `payload` must outlive this and the strings and octets that are read.
  explicit CdrReader(std::span<const std::byte> payload);

  [[nodiscard]] bool ok() const { return reason_.empty(); }

  /// Returns one line with place and reason; empty if ok.
  [[nodiscard]] std::string fault() const;

  /// Puts a field's name before the fault's path; called from the inside to the outside.
  void locate(const std::string& field);

  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }

  /// Returns the payload's byte after the last value.
  [[nodiscard]] std::size_t at() const { return header_bytes + at_; }

  template <typename T>
  [[nodiscard]] T read() {
    const std::byte* from = take(sizeof(T), sizeof(T));
    if (from == nullptr) return T{};
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
  }

  /// Reads `count` numbers.
  template <typename T>
  void read_array(T* to, std::size_t count) {
    const std::byte* from = take_array(count, sizeof(T));
    if (from == nullptr) {
      std::fill_n(to, count, T{});
      return;
    }
    std::memcpy(to, from, count * sizeof(T));
  }

  [[nodiscard]] bool read_bool();
  [[nodiscard]] std::string_view read_string();
  [[nodiscard]] std::span<const std::byte> read_octets(std::size_t count);

  /// Returns the number of elements of a sequence. A number that the rest of the payload cannot
  /// hold at `min_bytes` each is a fault.
  [[nodiscard]] std::size_t read_count(std::size_t min_bytes);

  /// Sets a fault of the last value, unless there is one already.
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

  // An empty array is not aligned.
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
  std::size_t fault_at_ = 0;
  std::string reason_;
  std::string path_;
};

}  // namespace penumbra::io
