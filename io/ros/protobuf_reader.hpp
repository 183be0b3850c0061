// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace penumbra::io {

/// How a field of protobuf lies on the wire.
enum class ProtobufWire : std::uint8_t { varint = 0, fixed64 = 1, bytes = 2, fixed32 = 5 };

struct ProtobufField {
  std::uint32_t number = 0;
  ProtobufWire wire = ProtobufWire::varint;
  std::uint64_t bits = 0;                 ///< of a number
  std::span<const std::byte> bytes = {};  ///< of a text, a message or packed numbers
};

/// Reads the fields of one protobuf message in the order of the wire
/// (https://protobuf.dev/programming-guides/encoding). It knows no schema.
class ProtobufReader {
 public:
  /// `message` must outlive this and the bytes of its fields.
  explicit ProtobufReader(std::span<const std::byte> message) : bytes_(message) {}

  /// Reads the next field. Returns false at the end and after a fault. Groups, which protobuf gave
  /// up, are a fault.
  bool next(ProtobufField& field);

  /// Returns one line with place and reason; empty: none.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  std::uint64_t read_varint();
  std::uint64_t read_fixed(std::size_t size);
  std::span<const std::byte> take(std::uint64_t count);
  void fail(const std::string& reason);

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::string fault_;
};

}  // namespace penumbra::io
