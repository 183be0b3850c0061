// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pattern.hpp"

#include <io/dds/participant.hpp>

namespace penumbra::test {

inline constexpr std::chrono::seconds dds_patience(120);

/// Waits until `is_so`, at most 120 s; calls it after each wait on the graph.
template <typename IsSo>
bool eventually(io::Participant& graph, IsSo is_so) {
  const auto end = std::chrono::steady_clock::now() + dds_patience;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    graph.wait(std::chrono::milliseconds(20));
  }
  return true;
}

/// The numbers of the pattern messages that wait in a subscription; -1 for what is none.
inline std::vector<std::int64_t> take_numbers(io::Subscription& subscription) {
  std::vector<std::int64_t> numbers;
  io::SerializedMessage sample;
  while (subscription.take(sample)) numbers.push_back(pattern_number(sample.data));
  return numbers;
}

/// The next `count` numbers; fewer if they do not come in time.
inline std::vector<std::int64_t> listen(io::Participant& graph, io::Subscription& subscription,
                                        std::size_t count) {
  std::vector<std::int64_t> numbers;
  eventually(graph, [&] {
    for (const std::int64_t number : take_numbers(subscription)) numbers.push_back(number);
    return numbers.size() >= count;
  });
  return numbers;
}

inline std::vector<std::int64_t> numbers_up_to(std::int64_t end) {
  std::vector<std::int64_t> numbers;
  for (std::int64_t i = 0; i < end; ++i) numbers.push_back(i);
  return numbers;
}

}  // namespace penumbra::test
