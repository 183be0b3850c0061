// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include <io/mcap/fault_log.hpp>
#include <io/mcap/record_format.hpp>

namespace penumbra::io::mcap {

/// The schemas and channels found in a file so far.
class Definitions {
 public:
  /// Adds a schema or channel record that is at `offset` or in the chunk there. The first
  /// definition of an id holds; a different one with the same id is a fault.
  void add(Opcode opcode, std::span<const std::byte> content, std::uint64_t offset,
           FaultLog& faults);

  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const { return channels_; }

  /// Returns whether a channel and its schema are known.
  [[nodiscard]] bool complete(std::uint16_t channel) const;

 private:
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::uint64_t bytes_ = 0;
};

}  // namespace penumbra::io::mcap
