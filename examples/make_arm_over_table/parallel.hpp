// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace example {

/// Calls f(row) once for every row, on as many threads as the machine has cores.
template <typename F>
void for_each_row(int rows, F&& f) {
  std::atomic<int> next = 0;
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
    threads.emplace_back([&] {
      for (int row = next++; row < rows; row = next++) f(row);
    });
}

}  // namespace example
