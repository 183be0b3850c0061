// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/files/background_jobs.hpp>

namespace penumbra::io {

BackgroundJobs::~BackgroundJobs() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    jobs_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void BackgroundJobs::add(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return fault_ || jobs_.size() < 2 * most_; });
  if (fault_) std::rethrow_exception(fault_);
  jobs_.push_back(std::move(job));
  if (threads_.size() < most_) threads_.emplace_back([this] { work(); });
  lock.unlock();
  changed_.notify_all();
}

void BackgroundJobs::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return jobs_.empty() && running_ == 0; });
  if (fault_) std::rethrow_exception(fault_);
}

void BackgroundJobs::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ends_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    ++running_;
    lock.unlock();
    std::exception_ptr fault;
    try {
      job();
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    --running_;
    if (fault && !fault_) {
      fault_ = fault;
      jobs_.clear();
    }
    changed_.notify_all();
  }
}

}  // namespace penumbra::io
