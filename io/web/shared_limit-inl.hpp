// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <utility>
#include <vector>

namespace penumbra::io {

/// A limit on what all clients use together: bytes that wait for them, or connections. When the
/// limit is exceeded, the oldest use is ended, so that one client cannot take everything.
class SharedLimit {
 public:
  explicit SharedLimit(std::size_t most) : most_(most) {}

  struct Use {
    std::size_t size;
    std::function<void()> close;  // any thread may call it
  };
  using Place = std::list<Use>::iterator;

  Place add(Use use) {
    std::vector<std::function<void()>> to_close;
    const Place place = add(std::move(use), to_close);
    for (const auto& close : to_close) close();
    return place;
  }

  void remove(Place place) {
    const std::lock_guard lock(mutex_);
    size_ -= place->size;
    uses_.erase(place);
  }

 private:
  /// Adds a use. The caller calls `to_close` without the mutex, because that may destroy a client,
  /// which removes its use.
  Place add(Use use, std::vector<std::function<void()>>& to_close) {
    const std::lock_guard lock(mutex_);
    size_ += use.size;
    for (auto old = uses_.begin(); size_ > most_ && old != uses_.end(); ++old) {
      if (old->size == 0) continue;
      size_ -= std::exchange(old->size, 0);
      to_close.push_back(old->close);
    }
    return uses_.insert(uses_.end(), std::move(use));
  }

  std::mutex mutex_;
  std::list<Use> uses_;  // oldest first
  std::size_t size_ = 0;
  std::size_t most_;
};

/// The use of a limit by a connection.
class ConnectionSlot {
 public:
  ConnectionSlot() = default;
  ConnectionSlot(const ConnectionSlot&) = delete;
  ConnectionSlot& operator=(const ConnectionSlot&) = delete;
  ~ConnectionSlot() { leave(); }

  /// Becomes the newest use of a limit and leaves the former limit.
  void take(SharedLimit& limit, std::function<void()> close) {
    leave();
    place_ = limit.add({1, std::move(close)});
    limit_ = &limit;
  }

 private:
  void leave() {
    if (limit_ != nullptr) std::exchange(limit_, nullptr)->remove(place_);
  }

  SharedLimit* limit_ = nullptr;
  SharedLimit::Place place_;
};

}  // namespace penumbra::io
