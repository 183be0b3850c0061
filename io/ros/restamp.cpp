// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include <io/ros/cdr_fields.hpp>
#include <io/ros/cdr_reader.hpp>
#include <io/ros/restamp.hpp>

namespace penumbra::io {
namespace {

using Types = std::vector<TypeDefinition>;

constexpr std::int64_t second = 1'000'000'000;

bool is_header(const TypeDefinition& type) { return type.name == "std_msgs/Header"; }

bool holds_headers(const FieldDefinition& field, const Types& types) {
  if (field.type != WireType::message) return false;
  const TypeDefinition& type = types[field.nested];
  return is_header(type) ||
         std::any_of(type.fields.begin(), type.fields.end(),
                     [&](const FieldDefinition& inner) { return holds_headers(inner, types); });
}

template <typename T>
void put(std::span<std::byte> payload, std::size_t at, T value, bool swaps) {
  if (swaps) value = byte_swapped(value);
  std::memcpy(payload.data() + at, &value, sizeof(T));
}

class StampWalk {
 public:
  StampWalk(std::span<std::byte> payload, const Types& types,
            const std::function<std::int64_t(std::int64_t)>& change)
      : payload_(payload), types_(types), change_(change), reader_(payload) {}

  std::optional<std::string> walk() {
    // What comes behind the last headers need not be read: images are long.
    const auto& fields = types_.front().fields;
    const auto end = std::find_if(fields.rbegin(), fields.rend(),
                                  [&](const auto& field) { return holds_headers(field, types_); });
    if (is_header(types_.front())) walk_message(types_.front());  // it holds no other
    for (auto field = fields.begin(); field != end.base() && reader_.ok(); ++field)
      walk_field(*field);
    if (reader_.ok()) return std::nullopt;
    return reader_.fault();
  }

 private:
  void walk_field(const FieldDefinition& field) {
    if (!holds_headers(field, types_)) {
      skip_field(reader_, field, types_);
      return;
    }
    const std::size_t count = count_values(reader_, field, min_bytes_each(field, types_));
    for (std::size_t i = 0; i < count && reader_.ok(); ++i) walk_message(types_[field.nested]);
    if (!reader_.ok()) reader_.locate(field.name);
  }

  void walk_message(const TypeDefinition& type) {
    for (const FieldDefinition& field : type.fields) {
      if (!reader_.ok()) return;
      if (is_header(type) && field.type == WireType::message &&
          types_[field.nested].name == "builtin_interfaces/Time")
        change_stamp();
      else
        walk_field(field);
    }
  }

  void change_stamp() {
    const auto seconds = reader_.read<std::int32_t>();
    const auto rest = reader_.read<std::uint32_t>();
    if (!reader_.ok() || (seconds == 0 && rest == 0)) return;
    const std::int64_t changed = change_(seconds * second + rest);
    if (changed <= 0 || changed / second > std::numeric_limits<std::int32_t>::max()) return;
    const std::size_t at = payload_.size() - reader_.remaining() - 8;
    put(payload_, at, static_cast<std::int32_t>(changed / second), reader_.swaps());
    put(payload_, at + 4, static_cast<std::uint32_t>(changed % second), reader_.swaps());
  }

  std::span<std::byte> payload_;
  const Types& types_;
  const std::function<std::int64_t(std::int64_t)>& change_;
  CdrReader reader_;
};

}  // namespace

Restamper::Restamper(std::string_view type, std::string_view definition)
    : definition_(type, definition) {
  refuse_wstrings(definition_);
  const Types& types = definition_.types();
  has_headers_ = is_header(types.front()) ||
                 std::any_of(types.front().fields.begin(), types.front().fields.end(),
                             [&](const auto& field) { return holds_headers(field, types); });
}

std::optional<std::string> Restamper::apply(
    std::span<std::byte> payload, const std::function<std::int64_t(std::int64_t)>& change) const {
  if (!has_headers_) return std::nullopt;
  return StampWalk(payload, definition_.types(), change).walk();
}

}  // namespace penumbra::io
