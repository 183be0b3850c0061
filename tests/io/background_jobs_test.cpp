// SPDX-License-Identifier: Apache-2.0
// Jobs on several threads: every one is done, few wait at a time, and the first fault is the one
// that is thrown.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <io/files/background_jobs.hpp>

namespace penumbra::io {
namespace {

using namespace std::chrono_literals;

TEST(BackgroundJobs, DoEveryJobAndKeepFewWaiting) {
  constexpr int threads = 3, jobs = 200;
  std::atomic<int> done = 0;
  int most_waiting = 0;
  BackgroundJobs background(threads);
  for (int i = 0; i < jobs; ++i) {
    background.add([&done] {
      std::this_thread::sleep_for(100us);
      ++done;
    });
    most_waiting = std::max(most_waiting, i + 1 - done);
  }
  background.finish();
  EXPECT_EQ(done, jobs);
  EXPECT_LE(most_waiting, 3 * threads) << "one runs and two wait for each thread";
}

TEST(BackgroundJobs, ThrowWhatAJobThrew) {
  BackgroundJobs background(4);
  const auto write = [&] {
    for (int i = 0; i < 40; ++i)
      background.add([i] {
        if (i == 5) throw std::runtime_error("job 5");
      });
    background.finish();
  };
  EXPECT_THROW(write(), std::runtime_error);
}

}  // namespace
}  // namespace penumbra::io
