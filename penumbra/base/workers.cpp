// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <system_error>

#include <unistd.h>

#include <penumbra/base/error.hpp>
#include <penumbra/base/workers.hpp>

namespace penumbra {

Workers::Workers(int size) : owner_(getpid()) {
  try {
    for (int worker = 1; worker < size; ++worker) {
      threads_.emplace_back([this, worker] { serve(worker); });
    }
  } catch (const std::system_error& error) {
    const std::size_t started = threads_.size() + 1;
    stop();
    throw InputError("threads: this machine gives no more than " + std::to_string(started) +
                     " of " + std::to_string(size) + " (" + error.what() + ")");
  }
}

Workers::~Workers() { stop(); }

void Workers::stop() {
  stop_ = true;
  ++round_;
  round_.notify_all();
  const bool is_forked = getpid() != owner_;
  for (std::thread& thread : threads_)
    if (is_forked)
      thread.detach();
    else
      thread.join();
}

void Workers::run(void (*job)(void*, int), void* context) {
  if (threads_.empty()) {
    job(context, 0);
    return;
  }
  if (getpid() != owner_)
    throw InputError(
        "threads: a forked process has none of its parent's; make what has threads in the child, "
        "or "
        "with one thread");
  job_ = job;
  context_ = context;
  busy_ = static_cast<int>(threads_.size());
  ++round_;
  round_.notify_all();
  job(context, 0);
  for (int busy = busy_; busy != 0; busy = busy_) busy_.wait(busy);
}

void Workers::serve(int worker) {
  for (std::uint32_t seen = 0;; ++seen) {
    round_.wait(seen);
    if (stop_) return;
    job_(context_, worker);
    if (--busy_ == 0) busy_.notify_one();
  }
}

}  // namespace penumbra
