// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/ros/cdr_reader.hpp>

namespace penumbra::io {
CdrReader::CdrReader(std::span<const std::byte> payload) {
  if (payload.size() < header_bytes) {
    fail(std::to_string(payload.size()) + " bytes are no CDR payload");
    return;
  }
  const auto kind =
      std::to_integer<std::size_t>(payload[0]) << 8 | std::to_integer<std::size_t>(payload[1]);
  if (kind != 1) {
    fail("its encapsulation is " + std::to_string(kind) + "; expected 1 (CDR_LE)");
    return;
  }
  bytes_ = payload.subspan(header_bytes);
}

std::string CdrReader::fault() const {
  if (ok()) return {};
  return (path_.empty() ? "" : path_ + ", ") + "byte " + std::to_string(fault_at_ + header_bytes) +
         ": " + reason_;
}

void CdrReader::locate(const std::string& field) {
  path_ = path_.empty() ? field : field + "." + path_;
}

bool CdrReader::read_bool() {
  const auto value = read<std::uint8_t>();
  if (value > 1) fail("a bool of value " + std::to_string(value));
  return value == 1;
}

std::string_view CdrReader::read_string() {
  const std::size_t size = read<std::uint32_t>();
  if (size == 0) return {};  // some writers leave out the end of an empty one
  const std::span<const std::byte> bytes = read_octets(size);
  if (bytes.empty()) return {};
  if (bytes.back() != std::byte{0}) {
    fail("a string of " + std::to_string(size) + " bytes without its end");
    return {};
  }
  return {reinterpret_cast<const char*>(bytes.data()), size - 1};
}

std::span<const std::byte> CdrReader::read_octets(std::size_t count) {
  const std::byte* from = take_array(count, 1);
  return from == nullptr ? std::span<const std::byte>{} : std::span(from, count);
}

std::size_t CdrReader::read_count(std::size_t min_bytes) {
  const std::size_t count = read<std::uint32_t>();
  if (count <= remaining() / min_bytes) return count;
  fail_short(count);
  return 0;
}

void CdrReader::fail(std::string reason) {
  if (!ok()) return;
  reason_ = std::move(reason);
  fault_at_ = at_;
  at_ = bytes_.size();
}

void CdrReader::fail_short(std::size_t count) {
  if (ok())
    fail("has " + std::to_string(remaining()) + " bytes left; expected " + std::to_string(count));
}

}  // namespace penumbra::io
