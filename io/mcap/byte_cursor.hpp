// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace penumbra::io::mcap {

static_assert(std::endian::native == std::endian::little, "MCAP's numbers are copied as they lie");

/// Reads MCAP's basic types one after another. A value that exceeds the bytes ends the reading:
/// ok() is false from then on, and all further values are empty or zero.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::byte> bytes) : rest_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

  std::span<const std::byte> bytes(std::uint64_t count) {
    if (!ok_ || count > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const auto taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(static_cast<std::size_t>(count));
    return taken;
  }

  template <typename T>
  T number() {
    static_assert(std::is_unsigned_v<T>);
    T value = 0;
    if (const auto taken = bytes(sizeof(T)); !taken.empty())
      std::memcpy(&value, taken.data(), sizeof(T));
    return value;
  }

  /// Reads a byte count and that many bytes: a text, map or array.
  std::span<const std::byte> counted() { return bytes(number<std::uint32_t>()); }

  std::string text() {
    const auto taken = counted();
    std::string value(taken.size(), '\0');
    if (!taken.empty()) std::memcpy(value.data(), taken.data(), taken.size());
    return value;
  }

 private:
  std::span<const std::byte> rest_;
  bool ok_ = true;
};

}  // namespace penumbra::io::mcap
