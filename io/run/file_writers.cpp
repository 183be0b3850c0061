// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/run/file_writers.hpp>

namespace penumbra::io {
namespace {

std::exception_ptr fault_of(const std::function<void()>& run) {
  try {
    run();
    return nullptr;
  } catch (...) {
    return std::current_exception();
  }
}

}  // namespace

FileWriters::~FileWriters() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    jobs_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void FileWriters::add(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return fault_ || jobs_.size() < 2 * most_; });
  rethrow_fault(lock);
  jobs_.push_back({added_++, std::move(job)});
  if (threads_.size() < most_) threads_.emplace_back([this] { work(); });
  lock.unlock();
  changed_.notify_all();
}

void FileWriters::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return jobs_.empty() && running_ == 0; });
  rethrow_fault(lock);
}

/// Jobs before the one that failed may still run, and may fail too.
void FileWriters::rethrow_fault(std::unique_lock<std::mutex>& lock) {
  if (!fault_) return;
  changed_.wait(lock, [&] { return running_ == 0; });
  std::rethrow_exception(fault_);
}

void FileWriters::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ends_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    ++running_;
    lock.unlock();
    const std::exception_ptr fault = fault_of(job.run);
    lock.lock();
    --running_;
    if (fault && (!fault_ || job.number < failed_)) {
      fault_ = fault;
      failed_ = job.number;
      jobs_.clear();
    }
    changed_.notify_all();
  }
}

}  // namespace penumbra::io
