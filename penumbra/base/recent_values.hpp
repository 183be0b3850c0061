// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <penumbra/base/stamps.hpp>

namespace penumbra {

/// Stamps remembered per target, and frames remembered by their poses.
inline constexpr std::size_t remembered_stamps = 128;

/// The values of the last stamps. Values keep their buffers.
template <typename T>
class RecentValues {
 public:
  /// Of the last `remembered_stamps` stamps.
  explicit RecentValues(const T& initial = {}) : entries_(remembered_stamps, {{}, initial}) {}
  /// Of the last `span` nanoseconds. Makes values when they are first needed.
  explicit RecentValues(std::int64_t span) : span_(static_cast<std::uint64_t>(span)) {}

  /// Returns the value of a stamp. A new stamp takes over the oldest entry if that is outside the
  /// span, or if there are `most`, up to `remembered_stamps`.
  T& at(std::int64_t stamp, std::size_t most = remembered_stamps) {
    if (const auto known = entry_of(stamp); known != entries_.end()) return known->value;
    const auto oldest = entries_.begin() + static_cast<std::ptrdiff_t>(oldest_);
    const bool is_over = !entries_.empty() && (!oldest->stamp || entries_.size() >= most ||
                                               entries_.size() >= remembered_stamps ||
                                               stamp_distance(*oldest->stamp, stamp) > span_);
    Entry& entry = is_over ? *oldest : *entries_.insert(oldest, Entry{});
    oldest_ = (oldest_ + 1) % entries_.size();
    entry.stamp = stamp;
    return entry.value;
  }
  /// Returns the value of exactly that stamp, or null.
  [[nodiscard]] const T* find(std::int64_t stamp) {
    const auto entry = entry_of(stamp);
    return entry == entries_.end() ? nullptr : &entry->value;
  }
  void clear() {
    for (Entry& entry : entries_) entry.stamp.reset();
  }

 private:
  struct Entry {
    std::optional<std::int64_t> stamp = {};
    T value = {};
  };

  auto entry_of(std::int64_t stamp) {
    return std::find_if(entries_.begin(), entries_.end(),
                        [&](const Entry& entry) { return entry.stamp == stamp; });
  }

  std::vector<Entry> entries_;  // from the oldest on in the order of writing, and from the first on
  std::size_t oldest_ = 0;
  std::uint64_t span_ = std::numeric_limits<std::uint64_t>::max();  // nanoseconds
};

}  // namespace penumbra
