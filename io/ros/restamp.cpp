// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <limits>

#include <io/ros/cdr_reader.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/restamp.hpp>

namespace penumbra::io {
namespace {

using Payload = std::span<const std::byte>;
using Headers = std::vector<MessageHeader>;
using StampFault = std::optional<std::string>;

constexpr std::int64_t second = 1'000'000'000;

StampFault find_first(Payload payload, Headers& headers) {
  CdrReader reader(payload);
  const std::int64_t seconds = reader.read<std::int32_t>();
  const auto rest = reader.read<std::uint32_t>();
  headers.push_back({.stamp = seconds * second + rest, .stamp_at = CdrReader::header_bytes});
  return reader.ok() ? std::nullopt : StampFault(reader.fault());
}

StampFault find_of_transforms(Payload payload, Headers& headers) {
  TfMessage message;
  StampFault fault = Decoder<TfMessage>().decode(payload, message);
  for (const TransformMessage& transform : message.transforms) headers.push_back(transform.header);
  return fault;
}

template <typename DetectionArray>
StampFault find_of_detections(Payload payload, Headers& headers) {
  DetectionArray message;
  StampFault fault = Decoder<DetectionArray>().decode(payload, message);
  headers.push_back(message.header);
  for (const auto& detection : message.detections) headers.push_back(detection.header);
  return fault;
}

template <typename M>
bool is_read_as(const MessageDefinition& definition) {
  return definition.types().front().type == M::ros_type &&
         difference_from_built_in(definition, M::ros_type).empty();
}

bool begins_with_header(const MessageDefinition& definition) {
  const MessageFields& root = definition.types().front();
  const bool begins = root.type == "std_msgs/Header" ||
                      (!root.fields.empty() && root.fields[0].starts_with("std_msgs/Header "));
  return begins && difference_from_built_in(definition, MessageHeader::ros_type).empty();
}

std::ptrdiff_t count_headers(const MessageDefinition& definition) {
  std::ptrdiff_t count = 0;
  for (const MessageFields& type : definition.types())
    count += std::count_if(type.fields.begin(), type.fields.end(), [](const std::string& field) {
      return field.starts_with("std_msgs/Header");
    });
  return count;
}

template <typename T>
void put(std::span<std::byte> payload, std::size_t at, T value) {
  std::memcpy(payload.data() + at, &value, sizeof(T));
}

}  // namespace

Restamper::Restamper(std::string_view type, std::string_view text) {
  const MessageDefinition definition(type, text);
  if (is_read_as<TfMessage>(definition)) {
    find_headers_ = find_of_transforms;
  } else if (is_read_as<Detection2DArrayMessage>(definition)) {
    find_headers_ = find_of_detections<Detection2DArrayMessage>;
  } else if (is_read_as<Detection3DArrayMessage>(definition)) {
    find_headers_ = find_of_detections<Detection3DArrayMessage>;
  } else {
    const bool begins = begins_with_header(definition);
    if (begins) find_headers_ = find_first;
    leaves_headers_ = text.empty() || count_headers(definition) > (begins ? 1 : 0);
  }
}

std::optional<std::string> Restamper::apply(
    std::span<std::byte> payload, const std::function<std::int64_t(std::int64_t)>& change) const {
  if (find_headers_ == nullptr) return std::nullopt;
  Headers headers;
  if (auto fault = find_headers_(payload, headers)) return fault;
  for (const MessageHeader& header : headers) {
    if (header.stamp == 0) continue;
    const std::int64_t changed = change(header.stamp);
    if (changed <= 0 || changed / second > std::numeric_limits<std::int32_t>::max()) continue;
    put(payload, header.stamp_at, static_cast<std::int32_t>(changed / second));
    put(payload, header.stamp_at + 4, static_cast<std::uint32_t>(changed % second));
  }
  return std::nullopt;
}

}  // namespace penumbra::io
