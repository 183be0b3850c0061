// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra {

/// Stamps remembered per target, and frames remembered by their poses.
inline constexpr std::size_t remembered_stamps = 128;

/// The values of the last `remembered_stamps` stamps. Values keep their buffers.
template <typename T>
class RecentValues {
 public:
  explicit RecentValues(const T& initial = {}) : entries_(remembered_stamps, {{}, initial}) {}

  /// Returns the value of a stamp; a new stamp takes over the oldest entry.
  T& at(std::int64_t stamp) {
    auto entry = entry_of(stamp);
    if (entry == entries_.end()) {
      next_ = (next_ + 1) % entries_.size();
      entry = entries_.begin() + static_cast<std::ptrdiff_t>(next_);
    }
    entry->stamp = stamp;
    return entry->value;
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
    std::optional<std::int64_t> stamp;
    T value;
  };

  auto entry_of(std::int64_t stamp) {
    return std::find_if(entries_.begin(), entries_.end(),
                        [&](const Entry& entry) { return entry.stamp == stamp; });
  }

  std::vector<Entry> entries_;
  std::size_t next_ = 0;  // the entry that was written last
};

}  // namespace penumbra
