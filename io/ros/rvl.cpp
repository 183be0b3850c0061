// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include <io/ros/cdr_reader.hpp>
#include <io/ros/rvl.hpp>

namespace penumbra::io {
namespace {

// Nibbles lie from the high end of little-endian words of 32 bits. The low three bits of each are a
// number's next higher ones, the fourth says that more follow.
class NibbleReader {
 public:
  explicit NibbleReader(std::span<const std::byte> packed) : packed_(packed) {}

  // Once it has failed, 0.
  std::uint32_t number() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < number_bits; shift += 3) {
      const std::uint32_t nibble = next();
      value |= (nibble & 7U) << shift;
      if ((nibble & 8U) == 0) return failed_ ? 0 : value;
    }
    failed_ = true;
    return 0;
  }

  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] bool at_end() const { return packed_.empty(); }

 private:
  static constexpr unsigned number_bits = 32;
  static constexpr unsigned word_nibbles = 8;

  std::uint32_t next() {
    if (left_ == 0) {
      if (packed_.size() < sizeof(word_)) {
        failed_ = true;
        return 0;
      }
      std::memcpy(&word_, packed_.data(), sizeof(word_));
      if constexpr (std::endian::native == std::endian::big) word_ = byte_swapped(word_);
      packed_ = packed_.subspan(sizeof(word_));
      left_ = word_nibbles;
    }
    --left_;
    const std::uint32_t nibble = word_ >> 28U;
    word_ <<= 4U;
    return nibble;
  }

  std::span<const std::byte> packed_;
  std::uint32_t word_ = 0;
  unsigned left_ = 0;
  bool failed_ = false;
};

// Differences alternate between the signs: 0, -1, 1, -2, ...
std::int64_t signed_of(std::uint32_t code) {
  const auto half = static_cast<std::int64_t>(code >> 1U);
  return (code & 1U) != 0 ? -half - 1 : half;
}

}  // namespace

std::optional<std::string> decode_rvl(std::span<const std::byte> packed,
                                      std::span<std::uint16_t> depths) {
  NibbleReader reader(packed);
  std::int64_t depth = 0;
  std::size_t at = 0;
  while (at < depths.size()) {
    const std::size_t zeros = reader.number();
    const std::size_t others = reader.number();
    if (reader.failed()) return "RVL data end too early";
    if (zeros > depths.size() - at || others > depths.size() - at - zeros)
      return "RVL data have more than " + std::to_string(depths.size()) + " pixels";
    std::fill_n(depths.begin() + static_cast<std::ptrdiff_t>(at), zeros, std::uint16_t{0});
    at += zeros;
    for (const std::size_t end = at + others; at < end; ++at) {
      depth += signed_of(reader.number());
      if (depth <= 0 || depth > std::numeric_limits<std::uint16_t>::max())
        return "RVL data are damaged: a depth of " + std::to_string(depth);
      depths[at] = static_cast<std::uint16_t>(depth);
    }
    if (reader.failed()) return "RVL data end too early";
  }
  if (!reader.at_end()) return "RVL data go on after the last pixel";
  return std::nullopt;
}

}  // namespace penumbra::io
