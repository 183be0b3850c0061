// SPDX-License-Identifier: Apache-2.0
// A type of DDS whose samples are bytes in CDR, whatever they mean.
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

/// What became of the samples that arrived as a type.
class ArrivalCounts {
 public:
  using Writer = std::array<std::byte, 16>;  // its GUID

  std::atomic<std::uint64_t> received = 0;
  std::atomic<std::uint64_t> overwritten = 0;
  std::atomic<std::uint64_t> lost = 0;

  /// Of a sample in its order of arrival: those whose numbers lie between it and the one before are
  /// lost.
  void note_number(const Writer& writer, std::int64_t number);

 private:
  static constexpr std::size_t most_writers = 1000;

  std::mutex mutex_;
  std::map<Writer, std::int64_t> last_;
};

/// A new type of that DDS name for one topic entity, which then owns it. Samples that arrive as it
/// are counted.
[[nodiscard]] ddsi_sertype* make_cdr_type(const std::string& dds_name,
                                          std::shared_ptr<ArrivalCounts> counts);

/// A sample to be written. Throws std::bad_alloc.
[[nodiscard]] ddsi_serdata* make_cdr_sample(const ddsi_sertype* type,
                                            std::span<const std::byte> bytes);

/// The bytes of a sample of such a type, which live as long as it.
[[nodiscard]] std::span<const std::byte> cdr_bytes(const ddsi_serdata* sample);

/// Owns one reference to a sample that was taken, which is overwritten no more.
[[nodiscard]] std::shared_ptr<const void> own_taken(ddsi_serdata* sample);

}  // namespace penumbra::io
