// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <utility>

#include <io/mcap/definitions.hpp>

namespace penumbra::io::mcap {
namespace {

// Returns whether the definition is new and consistent.
template <typename T>
bool keep(std::map<std::uint16_t, T>& all, std::optional<T>& found, const std::string& kind,
          std::uint64_t offset, FaultLog& faults) {
  if (!found) {
    faults.add(offset, "a " + kind + "'s record is damaged; left out");
    return false;
  }
  const auto known = all.find(found->id);
  if (known == all.end()) {
    all.emplace(found->id, std::move(*found));
    return true;
  }
  if (known->second != *found)
    faults.add(offset, kind + " " + std::to_string(found->id) +
                           " has another definition earlier in the file; the first one holds");
  return false;
}

}  // namespace

void Definitions::add(Opcode opcode, std::span<const std::byte> content, std::uint64_t offset,
                      FaultLog& faults) {
  if (bytes_ + content.size() > max_definition_bytes) {
    faults.add(offset, "schemas and channels have more than " +
                           std::to_string(max_definition_bytes) + " bytes; the rest is left out");
    return;
  }
  bool kept = false;
  if (opcode == Opcode::schema) {
    auto schema = parse_schema(content);
    if (schema && schema->id == 0)
      faults.add(offset, "a schema has the id 0, which means no schema; left out");
    else
      kept = keep(schemas_, schema, "schema", offset, faults);
  } else {
    auto channel = parse_channel(content);
    kept = keep(channels_, channel, "channel", offset, faults);
  }
  if (kept) bytes_ += content.size();
}

bool Definitions::complete(std::uint16_t channel) const {
  const auto known = channels_.find(channel);
  if (known == channels_.end()) return false;
  const std::uint16_t schema = known->second.schema_id;
  return schema == 0 || schemas_.contains(schema);
}

}  // namespace penumbra::io::mcap
