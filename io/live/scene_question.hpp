// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace penumbra::io {

/// When to ask MoveIt what is attached, because it publishes changes only, and what its answer is
/// worth. Images wait meanwhile. Uses no transport and no clock: `now` is the caller's.
class SceneQuestion {
 public:
  /// Nanoseconds after which a question is asked again, and for which a publisher of scenes, which
  /// may also be a bag, is awaited to have the service.
  static constexpr std::int64_t patience = 5'000'000'000;
  /// Images may come this much later than joint states of their stamp, nanoseconds.
  static constexpr std::int64_t longest_latency = 1'000'000'000;

  /// Follows the graph. A MoveIt that went away is asked again when it is back.
  void follow(bool has_service, bool has_publisher, std::int64_t now);
  /// Returns whether to ask, for the first time or again.
  [[nodiscard]] bool is_due(std::int64_t now) const;
  /// Notes that it was asked. `stamp`: the newest of the robot's states.
  void ask(std::int64_t now, std::int64_t stamp);
  /// Takes the answer. Returns the stamp from which it holds: messages that came after the question
  /// are newer. Returns nothing if the clock was set back meanwhile: ask again.
  [[nodiscard]] std::optional<std::int64_t> answer(std::int64_t stamp);
  /// Returns whether images wait. `has_service`: now.
  [[nodiscard]] bool waits(bool has_service) const {
    return !is_answered_ && (has_service || is_service_awaited_);
  }

 private:
  bool has_service_ = false, is_service_awaited_ = false, is_answered_ = false;
  std::optional<std::int64_t> publisher_since_;  // without the service
  std::optional<std::int64_t> asked_at_;         // not answered yet
  std::int64_t asked_stamp_ = 0;
};

}  // namespace penumbra::io
