// SPDX-License-Identifier: Apache-2.0
// The numbers in parentheses are sections of ITU-T H.264.
#include <algorithm>
#include <array>
#include <cstddef>

#include <io/files/h264.hpp>

namespace penumbra::io {
namespace {

/// Reads the bits of a NAL unit; zeros after its end.
class BitReader {
 public:
  explicit BitReader(std::string_view unit) : unit_(unit) {}

  std::uint32_t bits(int count) {
    std::uint32_t value = 0;
    while (count-- > 0) value = value << 1U | bit();
    return value;
  }
  std::uint32_t number() {  // ue(v) (9.1)
    int zeros = 0;
    while (zeros < 31 && bit() == 0) ++zeros;
    return (1U << zeros) - 1 + bits(zeros);
  }

 private:
  std::uint32_t bit() {
    // A 3 after two zeros is no data (7.4.1).
    if (at_ % 8 == 0 && at_ >= 16 &&
        unit_.substr(std::min(at_ / 8 - 2, unit_.size()), 3) == std::string_view("\0\0\3", 3))
      at_ += 8;
    if (at_ / 8 >= unit_.size()) return 0;
    const auto byte = static_cast<unsigned char>(unit_[at_ / 8]);
    return byte >> (7 - at_++ % 8) & 1U;
  }

  std::string_view unit_;
  std::size_t at_ = 0;
};

/// (7.3.2.1.1)
int read_number_bits(BitReader parameters) {
  parameters.bits(8);
  const std::uint32_t profile = parameters.bits(8);
  parameters.bits(16);
  parameters.number();
  constexpr std::array<std::uint32_t, 13> high{100, 110, 122, 244, 44,  83, 86,
                                               118, 128, 138, 139, 134, 135};
  if (std::ranges::find(high, profile) != high.end()) {
    if (parameters.number() == 3 && parameters.bits(1) == 1) return 0;  // planes apart
    parameters.number();
    parameters.number();
    parameters.bits(1);
    if (parameters.bits(1) == 1) return 0;  // scaling lists, which no camera has
  }
  return static_cast<int>(std::min(parameters.number(), 12U)) + 4;
}

}  // namespace

H264Frame read_h264(std::string_view message, int& number_bits) {
  constexpr std::string_view start("\0\0\1", 3);
  constexpr std::uint32_t slice = 1, idr_slice = 5, parameters = 7;
  H264Frame frame;
  for (std::size_t at = message.find(start); at != std::string_view::npos;) {
    at += start.size();
    const std::size_t next = message.find(start, at);
    const std::string_view bytes = message.substr(at, next - at);
    at = next;
    BitReader unit(bytes);
    unit.bits(1);
    const bool is_reference = unit.bits(2) != 0;
    const std::uint32_t type = unit.bits(5);
    if (type == parameters) {
      frame.parameters = bytes;
      number_bits = read_number_bits(BitReader(bytes));
    }
    if (type != slice && type != idr_slice) continue;
    if (unit.number() != 0) continue;  // not the picture's first slice
    ++frame.pictures;
    frame.is_between = unit.number() % 5 == 1;
    unit.number();
    frame.number = unit.bits(number_bits);
    frame.is_reference = is_reference;
    frame.is_key = type == idr_slice;
  }
  return frame;
}

}  // namespace penumbra::io
