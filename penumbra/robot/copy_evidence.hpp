// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

namespace penumbra {

/// Whether a source is a copy, by its last new values: a copy tells what another one told before
/// it, an echo. Two that read one encoder each come first now and then; a copy hardly ever does, as
/// messages of the other one are lost seldom.
class CopyEvidence {
 public:
  static constexpr int enough = 2;         ///< new values, of one kind, that tell what a source is
  static constexpr double share = 0.75;    ///< of its last new values that are echoes of a copy
  static constexpr int most_counted = 16;  ///< new values that are remembered

  void add_echo() { add(1); }

  /// A value that nobody told before. It counts once another one is known to have been heard at
  /// that stamp: what a copy tells while it alone hears the other one proves nothing.
  void add_own(std::int64_t stamp) {
    if (pending_.size() < most_counted) pending_.push_back(stamp);
  }

  /// `is_heard(stamp)` says whether another one was heard there; nothing: that is not known yet.
  template <typename IsHeard>
  void settle(const IsHeard& is_heard) {
    std::erase_if(pending_, [&](std::int64_t stamp) {
      const std::optional<bool> heard = is_heard(stamp);
      if (heard == true) add(0);
      return heard.has_value();
    });
  }

  [[nodiscard]] bool is_copy() const { return echoes() >= enough && echoes() >= share * count_; }

  /// Neither before it told new values.
  [[nodiscard]] bool is_own() const { return count_ - echoes() >= enough && !is_copy(); }

 private:
  [[nodiscard]] int echoes() const { return std::popcount(told_); }

  void add(std::uint32_t is_echo) {
    told_ = (told_ << 1 | is_echo) & ((1U << most_counted) - 1);
    count_ = std::min(count_ + 1, most_counted);
  }

  std::uint32_t told_ = 0;  // a bit each, the last one lowest
  int count_ = 0;
  std::vector<std::int64_t> pending_;  // stamps of values of its own
};

}  // namespace penumbra
