// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra::io {

/// Counts the messages of a sensor by result: received = judged + failed + dropped + waiting +
/// in_work.
struct ImageCounts {
  std::size_t received = 0;
  std::size_t judged = 0;  ///< judged and published
  std::size_t failed = 0;  ///< no result could be computed
  std::size_t waiting = 0;
  std::size_t in_work = 0;
  std::array<std::size_t, drop_reasons> dropped{};
  std::optional<DropReason> last_dropped = {};  ///< why the last of the dropped was

  // Targets that were never judged:
  std::size_t targets_replaced = 0;  ///< by newer targets of the same name
  /// Sums TargetInbox::discarded, the targets that waited when the setup changed, and the targets
  /// of frames that failed.
  std::size_t targets_discarded = 0;
  std::size_t early_targets = 0;  ///< messages received before robot and sensor were known

  [[nodiscard]] std::size_t of(DropReason reason) const {
    return dropped[static_cast<std::size_t>(reason)];
  }
  void drop(DropReason reason, std::size_t images = 1) {
    dropped[static_cast<std::size_t>(reason)] += images;
    if (images > 0) last_dropped = reason;
  }
};

/// When a sensor's last messages arrived, in nanoseconds of the caller's clock.
class Arrivals {
 public:
  void add(std::int64_t now) {
    if (last_) intervals_.push_back(now - *last_);
    if (intervals_.size() > most_intervals) intervals_.pop_front();
    last_ = now;
  }
  [[nodiscard]] std::optional<std::int64_t> last() const { return last_; }
  /// Returns the period, or nothing if it is not known yet. It is the shortest of the last
  /// intervals, because a long one may be a pause.
  [[nodiscard]] std::optional<std::int64_t> period() const {
    if (intervals_.empty()) return std::nullopt;
    return *std::min_element(intervals_.begin(), intervals_.end());
  }

 private:
  static constexpr std::size_t most_intervals = 4;
  std::optional<std::int64_t> last_;
  std::deque<std::int64_t> intervals_;
};

/// Notes the time from a stamp to its message's arrival, nanoseconds, if it is the least one.
inline void note_lag(std::int64_t stamp, std::int64_t now, std::optional<std::int64_t>& least) {
  if (stamp > 0) least = std::min(least.value_or(now - stamp), now - stamp);
}

}  // namespace penumbra::io
