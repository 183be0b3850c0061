// SPDX-License-Identifier: Apache-2.0
// Jobs on several threads: every one is done, few wait at a time, and the first fault is the one
// that is thrown.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include <io/run/file_writers.hpp>

namespace penumbra::io {
namespace {

using namespace std::chrono_literals;

TEST(FileWriters, DoEveryJobAndKeepFewWaiting) {
  constexpr int threads = 3, jobs = 200;
  std::atomic<int> done = 0;
  int most_waiting = 0;
  FileWriters writers(threads);
  for (int i = 0; i < jobs; ++i) {
    writers.add([&done] {
      std::this_thread::sleep_for(100us);
      ++done;
    });
    most_waiting = std::max(most_waiting, i + 1 - done);
  }
  writers.finish();
  EXPECT_EQ(done, jobs);
  EXPECT_LE(most_waiting, 3 * threads) << "one runs and two wait for each thread";
}

TEST(FileWriters, ThrowTheFirstFaultWhicheverThreadIsFaster) {
  for (int repeat = 0; repeat < 50; ++repeat) {
    FileWriters writers(4);
    std::string told;
    try {
      for (int i = 0; i < 40; ++i)
        writers.add([i] {
          if (i == 5) std::this_thread::sleep_for(1ms);
          if (i == 5 || i == 6 || i == 8) throw std::runtime_error("job " + std::to_string(i));
        });
      writers.finish();
    } catch (const std::runtime_error& error) {
      told = error.what();
    }
    EXPECT_EQ(told, "job 5");
  }
}

}  // namespace
}  // namespace penumbra::io
