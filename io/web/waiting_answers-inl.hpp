// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <utility>

namespace penumbra::io {

/// The answers and messages that wait for their clients. When they are too many, the oldest is
/// given up: who is that slow must not cost the others their memory.
class WaitingAnswers {
 public:
  explicit WaitingAnswers(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  struct Answer {
    std::size_t bytes;
    std::function<void()> give_up;  // may be called by any thread
  };
  using Place = std::list<Answer>::iterator;

  Place add(Answer answer) {
    const std::lock_guard lock(mutex_);
    bytes_ += answer.bytes;
    for (auto old = answers_.begin(); bytes_ > most_bytes_ && old != answers_.end(); ++old) {
      if (old->bytes == 0) continue;
      bytes_ -= std::exchange(old->bytes, 0);
      old->give_up();
    }
    return answers_.insert(answers_.end(), std::move(answer));
  }

  void remove(Place place) {
    const std::lock_guard lock(mutex_);
    bytes_ -= place->bytes;
    answers_.erase(place);
  }

 private:
  std::mutex mutex_;
  std::list<Answer> answers_;  // oldest first
  std::size_t bytes_ = 0;
  std::size_t most_bytes_;
};

}  // namespace penumbra::io
