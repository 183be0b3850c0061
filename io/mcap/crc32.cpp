// SPDX-License-Identifier: Apache-2.0
// Processes sixteen bytes a step with sixteen tables ("slicing"): Kounavis and Berry, A Systematic
// Approach to Building High Performance Software-Based CRC Generators, 2005.
#include <array>
#include <bit>
#include <cstring>

#include <io/mcap/crc32.hpp>

namespace penumbra::io::mcap {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are taken four at a time");

constexpr std::size_t slices = 16;
using CrcTables = std::array<std::array<std::uint32_t, 256>, slices>;

// tables[k][b]: the effect of a byte b on the state if k zero bytes follow it.
constexpr CrcTables make_crc_tables() {
  CrcTables tables{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t state = b;
    for (int bit = 0; bit < 8; ++bit) state = state >> 1 ^ ((state & 1) != 0 ? 0xedb88320U : 0U);
    tables[0][b] = state;
  }
  for (std::size_t k = 1; k < slices; ++k)
    for (std::size_t b = 0; b < 256; ++b) {
      const std::uint32_t before = tables[k - 1][b];
      tables[k][b] = before >> 8 ^ tables[0][before & 0xff];
    }
  return tables;
}

constexpr CrcTables crc_tables = make_crc_tables();

std::uint32_t four_bytes(const std::byte* from) {
  std::uint32_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Returns the effect of four bytes that are followed by `zeros` of the step's sixteen.
std::uint32_t folded(std::uint32_t bytes, std::size_t zeros) {
  return crc_tables[zeros + 3][bytes & 0xff] ^ crc_tables[zeros + 2][bytes >> 8 & 0xff] ^
         crc_tables[zeros + 1][bytes >> 16 & 0xff] ^ crc_tables[zeros][bytes >> 24];
}

}  // namespace

void Crc32::add(std::span<const std::byte> bytes) {
  std::uint32_t state = state_;
  const std::byte* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= slices; left -= slices, at += slices)
    state = folded(four_bytes(at) ^ state, 12) ^ folded(four_bytes(at + 4), 8) ^
            folded(four_bytes(at + 8), 4) ^ folded(four_bytes(at + 12), 0);
  for (; left > 0; --left, ++at)
    state = state >> 8 ^ crc_tables[0][(state ^ static_cast<std::uint32_t>(*at)) & 0xff];
  state_ = state;
}

}  // namespace penumbra::io::mcap
