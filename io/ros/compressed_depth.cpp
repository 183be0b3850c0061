// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include <io/files/depth_pixels.hpp>
#include <io/files/image_size.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>
#include <io/ros/compressed_depth-inl.hpp>

namespace penumbra::io {
namespace {

// Reads numbers of nibbles, which start at the high end of little-endian words of 32 bits. The low
// three bits of a nibble are the next higher bits of the number; the fourth bit says that more
// nibbles follow.
class NibbleReader {
 public:
  explicit NibbleReader(std::span<const std::byte> packed) : packed_(packed) {}

  // Returns 0 after a failure.
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

constexpr std::string_view transport = "compressedDepth";

// As compressed_depth_image_transport writes it: little-endian numbers.
constexpr std::size_t parameter_bytes = 12;
constexpr std::uint32_t inverse_depth = 0;
struct DepthParameters {
  std::uint32_t format;
  float quant_a;
  float quant_b;
};

// Rows and columns before RVL's data. Zeros pack so well that any size may be true of few bytes:
// depth cameras have less than this many pixels.
constexpr std::size_t rvl_size_bytes = 8;
constexpr std::uint64_t most_rvl_pixels = std::uint64_t{1} << 24U;

template <typename T>
T little_endian(std::span<const std::byte> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::optional<std::string> unpack_rvl(std::span<const std::byte> bytes,
                                      Image<std::uint16_t>& image) {
  if (bytes.size() < rvl_size_bytes) return "ends before its RVL data";
  const auto width = little_endian<std::uint32_t>(bytes, 0);
  const auto height = little_endian<std::uint32_t>(bytes, 4);
  if (auto fault = check_image_size(width, height)) return fault;
  if (std::uint64_t{width} * height > most_rvl_pixels)
    return "has " + std::to_string(width) + " x " + std::to_string(height) +
           " pixels in RVL; at most " + std::to_string(most_rvl_pixels) + " are possible";
  image.fit(static_cast<int>(width), static_cast<int>(height));
  auto fault = decode_rvl(bytes.subspan(rvl_size_bytes), std::span(image.data(), image.size()));
  if (fault) fault->insert(0, "is damaged: ");
  return fault;
}

// "ENCODING; compressedDepth CODEC"; without a codec it is PNG.
struct DepthFormat {
  std::string_view encoding;
  std::string_view codec;
};

DepthFormat parse_format(std::string_view format) {
  const std::size_t at = format.find(transport);
  std::string_view encoding = trimmed(format.substr(0, at));
  if (encoding.ends_with(';')) encoding = trimmed(encoding.substr(0, encoding.size() - 1));
  const std::string_view codec = trimmed(format.substr(at + transport.size()));
  return {encoding, codec.empty() ? "png" : codec};
}

Image<float> dequantised(const Image<std::uint16_t>& quantised, float a, float b) {
  Image<float> metres(quantised.width(), quantised.height());
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const std::uint16_t q = quantised.data()[i];
    metres.data()[i] =
        q == 0 ? std::numeric_limits<float>::quiet_NaN() : a / (static_cast<float>(q) - b);
  }
  return metres;
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
  if (!reader.at_end()) return "RVL data continue after the last pixel";
  return std::nullopt;
}

bool is_compressed_depth(const CompressedImageMessage& message) {
  return message.format.find(transport) != std::string::npos;
}

std::optional<std::string> decode_compressed_depth(const CompressedImageMessage& message,
                                                   SharedDepth& depth) {
  const DepthFormat format = parse_format(message.format);
  const bool is_float = format.encoding == "32FC1";
  if ((!is_float && format.encoding != "16UC1") || (format.codec != "png" && format.codec != "rvl"))
    return "has format '" + printable(message.format) +
           "'; expected '16UC1; compressedDepth' or '32FC1; compressedDepth', png or rvl";
  if (message.data.size() < parameter_bytes) return "ends before its data";
  const auto packed = message.data.subspan(parameter_bytes);
  Image<std::uint16_t> millimetres;
  auto fault =
      format.codec == "rvl" ? unpack_rvl(packed, millimetres) : decode_png(packed, millimetres);
  if (fault) return fault;
  if (!is_float) {
    depth = shared_depth_of(std::move(millimetres), {});
    return std::nullopt;
  }
  const DepthParameters parameters{little_endian<std::uint32_t>(message.data, 0),
                                   little_endian<float>(message.data, 4),
                                   little_endian<float>(message.data, 8)};
  if (parameters.format != inverse_depth || !(parameters.quant_a > 0) ||
      !std::isfinite(parameters.quant_a) || !std::isfinite(parameters.quant_b))
    return "has no parameters by which 32FC1 was quantised";
  depth = shared_depth_of(dequantised(millimetres, parameters.quant_a, parameters.quant_b), {});
  return std::nullopt;
}

}  // namespace penumbra::io
