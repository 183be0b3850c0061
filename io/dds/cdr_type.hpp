// SPDX-License-Identifier: Apache-2.0
// A DDS type whose samples are CDR bytes of any message.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

namespace penumbra::io {

/// Counts the received and lost samples of a type.
class ArrivalCounts {
 public:
  using Writer = std::array<std::byte, 16>;  // the writer's GUID

  std::atomic<std::uint64_t> received = 0;
  std::atomic<std::uint64_t> overwritten = 0;
  std::atomic<std::uint64_t> lost = 0;

  /// Records the sequence number of a sample, in the order of arrival. Samples with numbers between
  /// the previous one and this one are lost.
  void note_number(const Writer& writer, std::int64_t number);

 private:
  static constexpr std::size_t most_writers = 1000;

  std::mutex mutex_;
  std::map<Writer, std::int64_t> last_;
};

/// Returns a new type with this DDS name for one topic entity, which then owns it. Samples received
/// with this type are counted.
[[nodiscard]] ddsi_sertype* make_cdr_type(const std::string& dds_name,
                                          std::shared_ptr<ArrivalCounts> counts);

/// Returns a sample to write. Throws std::bad_alloc.
[[nodiscard]] ddsi_serdata* make_cdr_sample(const ddsi_sertype* type,
                                            std::span<const std::byte> bytes);

/// Returns the bytes of a sample of such a type, valid while the sample exists.
[[nodiscard]] std::span<const std::byte> cdr_bytes(const ddsi_serdata* sample);

/// Owns one reference to a taken sample, which is not overwritten any more.
[[nodiscard]] std::shared_ptr<const void> own_taken(ddsi_serdata* sample);

}  // namespace penumbra::io
