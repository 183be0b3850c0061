// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <vector>

namespace penumbra::planning {

/// Calls work(thread, index) for each index below `count`, on some threads.
inline void parallel_for(int threads, std::size_t count,
                         const std::function<void(std::size_t, std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto take = [&](std::size_t thread) {
    for (std::size_t i = next++; i < count; i = next++) work(thread, i);
  };
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < std::min(static_cast<std::size_t>(threads), count); ++i)
    others.push_back(std::async(std::launch::async, take, i));
  take(0);
  for (std::future<void>& other : others) other.get();
}

}  // namespace penumbra::planning
