// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
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

/// The number of a message of pattern_message(); -1 if it is none.
inline std::int64_t pattern_number(std::span<const std::byte> message) {
  if (message.size() < pattern_header || message[1] != std::byte{1}) return -1;
  std::uint32_t number = 0;
  std::memcpy(&number, message.data() + 4, sizeof(number));
  const auto wanted = pattern_message(number, message.size());
  return std::equal(message.begin() + 4, message.end(), wanted.begin() + 4) ? number : -1;
}

/// Nanoseconds since 1970.
inline std::int64_t system_now() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

// Messages in CDR that begin with a header: the stamp stands behind the 4 bytes of encapsulation.

inline constexpr std::int64_t nanoseconds_in_second = 1'000'000'000;

inline void set_stamp(std::span<std::byte> message, std::int64_t stamp) {
  const auto whole = static_cast<std::int32_t>(stamp / nanoseconds_in_second);
  const auto rest = static_cast<std::uint32_t>(stamp % nanoseconds_in_second);
  std::memcpy(message.data() + 4, &whole, sizeof(whole));
  std::memcpy(message.data() + 8, &rest, sizeof(rest));
}

inline std::int64_t stamp_of(std::span<const std::byte> message) {
  std::int32_t whole = 0;
  std::uint32_t rest = 0;
  std::memcpy(&whole, message.data() + 4, sizeof(whole));
  std::memcpy(&rest, message.data() + 8, sizeof(rest));
  return whole * nanoseconds_in_second + rest;
}

/// FNV-1a, eight bytes at a time: another image has another one.
inline std::uint64_t digest_of(std::span<const std::byte> message) {
  std::uint64_t digest = 0xcbf29ce484222325U;
  for (std::size_t at = 0; at < message.size(); at += sizeof(digest)) {
    std::uint64_t word = 0;
    std::memcpy(&word, message.data() + at, std::min(sizeof(word), message.size() - at));
    digest = (digest ^ word) * 0x100000001b3U;
    digest ^= digest >> 29U;
  }
  return digest;
}

/// The first tick after a time, nanoseconds: programs with the same `hertz` have the same ticks.
inline std::int64_t next_tick(std::int64_t time, std::int64_t hertz) {
  const std::int64_t second = time / nanoseconds_in_second;
  const std::int64_t tick = (time % nanoseconds_in_second + 1) * hertz / nanoseconds_in_second + 1;
  return second * nanoseconds_in_second + tick * nanoseconds_in_second / hertz;
}

}  // namespace penumbra::test
