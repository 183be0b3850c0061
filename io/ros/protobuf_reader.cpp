// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>

#include <io/ros/protobuf_reader.hpp>

namespace penumbra::io {

static_assert(std::endian::native == std::endian::little, "numbers are copied unchanged");

bool ProtobufReader::next(ProtobufField& field) {
  if (at_ == bytes_.size() || !fault_.empty()) return false;
  const std::uint64_t tag = read_varint();
  field.number = static_cast<std::uint32_t>(tag >> 3);
  field.wire = static_cast<ProtobufWire>(tag & 7);
  field.bytes = {};
  if (field.number == 0 || tag >> 32 != 0) fail("a field of number " + std::to_string(tag >> 3));
  switch (field.wire) {
    case ProtobufWire::varint:
    case ProtobufWire::bytes:
      field.bits = read_varint();
      break;
    case ProtobufWire::fixed64:
      field.bits = read_fixed(sizeof(std::uint64_t));
      break;
    case ProtobufWire::fixed32:
      field.bits = read_fixed(sizeof(std::uint32_t));
      break;
    default:
      fail("a field of wire type " + std::to_string(tag & 7));
  }
  if (field.wire == ProtobufWire::bytes) field.bytes = take(field.bits);
  return fault_.empty();
}

std::uint64_t ProtobufReader::read_varint() {
  constexpr int digits = 64;
  std::uint64_t value = 0;
  for (int shift = 0; shift < digits; shift += 7) {
    const auto taken = take(1);
    if (taken.empty()) return 0;
    const auto octet = std::to_integer<std::uint64_t>(taken.front());
    value |= (octet & 0x7f) << shift;
    if (octet < 0x80) return value;
  }
  fail("a number of more than 10 bytes");
  return 0;
}

std::uint64_t ProtobufReader::read_fixed(std::size_t size) {
  std::uint64_t value = 0;
  if (const auto taken = take(size); !taken.empty())
    std::memcpy(&value, taken.data(), taken.size());
  return value;
}

std::span<const std::byte> ProtobufReader::take(std::uint64_t count) {
  const std::size_t rest = bytes_.size() - at_;
  if (count > rest)
    fail("has " + std::to_string(rest) + " bytes left; expected " + std::to_string(count));
  if (!fault_.empty()) return {};
  const auto taken = bytes_.subspan(at_, static_cast<std::size_t>(count));
  at_ += taken.size();
  return taken;
}

void ProtobufReader::fail(const std::string& reason) {
  if (fault_.empty()) fault_ = "byte " + std::to_string(at_) + ": " + reason;
}

}  // namespace penumbra::io
