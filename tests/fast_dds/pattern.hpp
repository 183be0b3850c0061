// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace penumbra::test {

inline constexpr std::size_t pattern_header = 12;  // encapsulation, number, size

/// A message that says which one it is: CDR_LE, its number, its size and bytes that follow from
/// both. `size`: with all of these, 12 or more.
inline std::vector<std::byte> pattern_message(std::uint32_t number, std::size_t size) {
  std::vector<std::byte> message(size);
  message[1] = std::byte{1};
  const auto stated = static_cast<std::uint32_t>(size);
  std::memcpy(message.data() + 4, &number, sizeof(number));
  std::memcpy(message.data() + 8, &stated, sizeof(stated));
  for (std::size_t i = pattern_header; i < size; ++i)
    message[i] = static_cast<std::byte>((i * 2654435761U + number * 40503U) >> 13U);
  return message;
}

/// The number of a message of pattern_message(), in which every `stride`th byte is looked at; -1 if
/// it is none.
inline std::int64_t pattern_number(std::span<const std::byte> message, std::size_t stride = 1) {
  if (message.size() < pattern_header || message[1] != std::byte{1}) return -1;
  std::uint32_t number = 0, stated = 0;
  std::memcpy(&number, message.data() + 4, sizeof(number));
  std::memcpy(&stated, message.data() + 8, sizeof(stated));
  if (stated != message.size()) return -1;
  for (std::size_t i = pattern_header; i < message.size(); i += stride)
    if (message[i] != static_cast<std::byte>((i * 2654435761U + number * 40503U) >> 13U)) return -1;
  return number;
}

}  // namespace penumbra::test
