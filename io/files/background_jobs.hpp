// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace penumbra::io {

/// Runs jobs on its own threads. At most twice as many jobs as threads wait, so
/// that memory stays bounded. After a job has failed no other one begins.
class BackgroundJobs {
 public:
  /// `threads`: how many at most; they start with the first jobs.
  explicit BackgroundJobs(std::size_t threads) : most_(threads) {}
  ~BackgroundJobs();  ///< drops the jobs that have not begun
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  /// Queues a job, and waits while the queue is full. Throws what a job threw.
  void add(std::function<void()> job);

  /// Waits until all jobs are done. Throws as add().
  void finish();

 private:
  void work();

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::size_t running_ = 0;
  std::exception_ptr fault_;  // of the first job that failed
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace penumbra::io
