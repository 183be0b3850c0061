// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace penumbra {

/// A fixed team that runs one job at a time, the caller included. A team of one has no threads.
class Workers {
 public:
  /// Throws InputError if the machine does not give as many threads.
  explicit Workers(int size);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls job(context, worker) once in every worker 0..size-1 and waits for all of them. Throws
  /// InputError in a process that was forked off, which has no threads of its own.
  void run(void (*job)(void* context, int worker), void* context);

 private:
  void serve(int worker);
  void stop();

  void (*job_)(void*, int) = nullptr;
  void* context_ = nullptr;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<int> busy_{0};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
  int owner_;  // process
};

}  // namespace penumbra
