// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <penumbra/tracking/track.hpp>

#include <sim/experiments/results.hpp>

namespace penumbra::sim {

/// A method and its answers on their way. Answers come late, those of one instant in the order of
/// their images.
template <typename Method, typename Answer>
class Follower {
 public:
  explicit Follower(std::unique_ptr<Method> method) : method_(std::move(method)) {}

  [[nodiscard]] Method& method() { return *method_; }
  [[nodiscard]] MethodRun& run() { return run_; }

  void post(std::int64_t arrival, Answer answer, const Event& event) {
    late_.push_back({arrival, std::move(answer), event});
  }

  /// Gives the method what has arrived by now.
  void deliver(std::int64_t now) {
    const auto first = std::stable_partition(late_.begin(), late_.end(),
                                             [&](const Late& l) { return l.arrival > now; });
    std::stable_sort(first, late_.end(),
                     [](const Late& a, const Late& b) { return a.arrival < b.arrival; });
    for (auto late = first; late != late_.end(); ++late) {
      if (late->answer.estimate)
        late->event.accepted = method_->take(late->answer) == Outcome::accepted;
      run_.events.push_back(late->event);
    }
    late_.erase(first, late_.end());
  }

 private:
  struct Late {
    std::int64_t arrival;  // nanoseconds
    Answer answer;
    Event event;
  };

  std::unique_ptr<Method> method_;
  MethodRun run_;
  std::vector<Late> late_;
};

}  // namespace penumbra::sim
