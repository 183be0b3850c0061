// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <io/mcap/record_format.hpp>

namespace penumbra::io::mcap {

/// Builds records one after another: call begin(), add the fields in order, call end().
class RecordBuilder {
 public:
  [[nodiscard]] std::span<const std::byte> view() const { return bytes_; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  void clear() { bytes_.clear(); }

  void bytes(std::span<const std::byte> value) {
    bytes_.insert(bytes_.end(), value.begin(), value.end());
  }

  template <typename T>
  void number(T value) {
    static_assert(std::is_unsigned_v<T>);
    bytes(std::as_bytes(std::span(&value, 1)));
  }

  /// Appends a text, which must be shorter than 4 GB.
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes(std::as_bytes(std::span(value)));
  }

  void begin(Opcode opcode) {
    number(static_cast<std::uint8_t>(opcode));
    record_ = begin_counted<std::uint64_t>();
  }
  void end() { end_counted<std::uint64_t>(record_); }

  /// Opens a field that is preceded by its byte count. Returns the value that closes it.
  template <typename T>
  [[nodiscard]] std::size_t begin_counted() {
    number(T{0});
    return bytes_.size();
  }
  template <typename T>
  void end_counted(std::size_t start) {
    const T count = static_cast<T>(bytes_.size() - start);
    std::memcpy(bytes_.data() + start - sizeof count, &count, sizeof count);
  }

 private:
  std::vector<std::byte> bytes_;
  std::size_t record_ = 0;
};

// Each function appends one record.
void put_schema(RecordBuilder& to, const Schema& schema);
void put_channel(RecordBuilder& to, const Channel& channel);
void put_statistics(RecordBuilder& to, const Statistics& statistics);
/// Appends the head of a chunk record, except records_offset.
void put_chunk_head(RecordBuilder& to, const ChunkHead& head);

}  // namespace penumbra::io::mcap
