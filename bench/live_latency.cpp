// SPDX-License-Identifier: Apache-2.0
// Measures a running `penumbra live` from outside, over DDS:
//   live_latency PID SECONDS CSV
// From the publication of each depth image (DDS's source timestamp) to the arrival of its labels
// and its filtered depth here, by stamp. Counts from the first labels on, prints a line each minute
// with the memory of process PID, and writes each frame to CSV. Threads that only sleep notice when
// a core stands still, as in a guest whose host has other work: quantiles are also given without
// the frames during such stalls. bench/soak.sh runs it.
#include "../tests/support/process_memory.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <pthread.h>
#include <sched.h>

#include <io/dds/participant.hpp>

namespace penumbra::bench {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto patience = 5s;  // a result that takes longer counts as lost
constexpr std::array result_names = {"labels", "filtered_depth"};
constexpr std::size_t results = result_names.size();

std::int64_t system_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Returns the stamp of a message that begins with a header, in little-endian CDR.
std::int64_t stamp_of(const io::SerializedMessage& message) {
  std::array<std::uint32_t, 3> words{};  // encapsulation, seconds, nanoseconds
  if (message.data.size() < sizeof(words)) throw std::runtime_error("a message without a header");
  std::memcpy(words.data(), message.data.data(), sizeof(words));
  return std::int64_t{words[1]} * 1'000'000'000 + words[2];
}

struct Frame {
  std::int64_t published = 0;                   // nanoseconds since 1970; 0: not received here
  std::array<std::int64_t, results> arrived{};  // likewise
};

/// When a core did not run a thread of the highest permitted priority, which sleeps for 3 ms,
/// within 15 ms.
class Stalls {
 public:
  Stalls() {
    for (unsigned core = 0; core < std::max(1U, std::thread::hardware_concurrency()); ++core)
      threads_.emplace_back([this, core] { watch(core); });
  }
  ~Stalls() {
    ends_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  Stalls(const Stalls&) = delete;
  Stalls& operator=(const Stalls&) = delete;

  /// Returns whether a stall overlaps an interval, or ended up to 0.1 s before it: what waited then
  /// is caught up on.
  [[nodiscard]] bool meet(std::int64_t begin, std::int64_t end) {
    const std::lock_guard lock(mutex_);
    return std::any_of(stalls_.begin(), stalls_.end(), [&](const auto& stall) {
      return stall.first <= end && stall.second + 100'000'000 >= begin;
    });
  }
  [[nodiscard]] std::string text() {
    const std::lock_guard lock(mutex_);
    std::int64_t longest = 0;
    for (const auto& [begin, end] : stalls_) longest = std::max(longest, end - begin);
    return std::to_string(stalls_.size()) + " stalls of a core, the longest " +
           std::to_string(longest / 1'000'000) + " ms";
  }

 private:
  void watch(unsigned core) {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    CPU_SET(core, &cores);
    pthread_setaffinity_np(pthread_self(), sizeof(cores), &cores);
    const sched_param priority{.sched_priority = 20};              // above that of bench/soak.sh
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);  // where it is permitted
    for (std::int64_t last = system_now(); !ends_;) {
      std::this_thread::sleep_for(3ms);
      const std::int64_t now = system_now();
      if (now - last > 15'000'000) {
        const std::lock_guard lock(mutex_);
        stalls_.emplace_back(last, now);
      }
      last = now;
    }
  }

  std::mutex mutex_;
  std::vector<std::pair<std::int64_t, std::int64_t>> stalls_;  // guarded by mutex_
  std::atomic<bool> ends_ = false;
  std::vector<std::thread> threads_;
};

/// Durations in milliseconds.
class Latencies {
 public:
  void add(double ms) { all_.push_back(ms); }
  [[nodiscard]] std::string text() {
    if (all_.empty()) return "none";
    std::sort(all_.begin(), all_.end());
    const auto at = [&](double share) {
      return all_[static_cast<std::size_t>(share * static_cast<double>(all_.size() - 1))];
    };
    std::array<char, 128> line{};
    std::snprintf(line.data(), line.size(), "p50 %.2f, p99 %.2f, p99.9 %.2f, largest %.2f ms",
                  at(0.5), at(0.99), at(0.999), at(1.0));
    return line.data();
  }
  void clear() { all_.clear(); }

 private:
  std::vector<double> all_;
};

class Watch {
 public:
  Watch(std::string process, double seconds, const std::string& csv)
      : process_(std::move(process)), seconds_(seconds), csv_(csv) {
    if (!csv_) throw std::runtime_error(csv + ": cannot be written");
    csv_ << "stamp_ns,published_ns,labels_ms,filtered_depth_ms,stalled\n";
  }

  void run() {
    const auto give_up = Clock::now() + 60s;
    while (!begun_ && Clock::now() < give_up) step();
    if (!begun_) throw std::runtime_error("no labels within a minute");
    const auto start = Clock::now();
    report(0);
    for (int minute = 1; elapsed(start) < seconds_; ++minute) {
      while (elapsed(start) < std::min(seconds_, 60.0 * minute)) step();
      report(minute);
    }
    ends_at_ = system_now();
    const auto end = Clock::now() + patience;
    while (Clock::now() < end) step();
    settle(std::numeric_limits<std::int64_t>::max());
    std::printf("all: %zu images published, %llu of them not received here; %s\n",
                images_ + missed(), static_cast<unsigned long long>(missed()),
                stalls_.text().c_str());
    for (std::size_t i = 0; i < results; ++i) {
      std::printf("%s: %zu lost, %s\n", result_names[i], lost_[i], all_[i].text().c_str());
      std::printf("  without stalls: %zu images, %zu lost, %s\n", images_ - stalled_,
                  lost_steady_[i], steady_[i].text().c_str());
    }
  }

 private:
  static double elapsed(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  [[nodiscard]] std::uint64_t missed() const { return images_in_->status().lost - missed_before_; }

  void step() {
    graph_->wait(20ms);
    io::SerializedMessage message;
    for (std::size_t i = 0; i < results; ++i)
      while (results_in_[i]->take(message)) {
        const std::int64_t now = system_now();
        if (!begun_ && i == 0) begin(stamp_of(message));
        if (begun_) waiting_[stamp_of(message)].arrived[i] = now;
      }
    while (images_in_->take(message))
      if (begun_) waiting_[stamp_of(message)].published = message.source_time;
    settle(system_now() - std::chrono::nanoseconds(patience).count());
  }

  /// Counts frames from the one after `stamp` on.
  void begin(std::int64_t stamp) {
    begun_ = true;
    first_ = stamp;
    missed_before_ = images_in_->status().lost;
  }

  /// Counts and writes the frames that were stamped before `end`.
  void settle(std::int64_t end) {
    for (; !waiting_.empty() && waiting_.begin()->first < end; waiting_.erase(waiting_.begin())) {
      const auto& [stamp, frame] = *waiting_.begin();
      if (stamp <= first_ || frame.published == 0 || frame.published >= ends_at_) continue;
      const std::int64_t last = *std::max_element(frame.arrived.begin(), frame.arrived.end());
      const bool stalled = stalls_.meet(stamp, std::max(frame.published, last));
      ++images_;
      stalled_ += stalled ? 1 : 0;
      csv_ << stamp << ',' << frame.published;
      for (std::size_t i = 0; i < results; ++i) {
        csv_ << ',';
        if (frame.arrived[i] == 0) {
          ++lost_[i];
          lost_steady_[i] += stalled ? 0 : 1;
          continue;
        }
        const double ms = 1e-6 * static_cast<double>(frame.arrived[i] - frame.published);
        all_[i].add(ms);
        if (!stalled) steady_[i].add(ms);
        if (i == 0) last_minute_.add(ms);
        csv_ << ms;
      }
      csv_ << ',' << (stalled ? 1 : 0) << '\n';
    }
  }

  void report(int minute) {
    const test::ProcessMemory memory = test::memory_of(process_);
    std::printf("minute %d: %zu images, labels: %zu lost, %s; live has %.1f MiB, %zu files; %s\n",
                minute, images_, lost_[0], last_minute_.text().c_str(), memory.resident,
                memory.open_files, stalls_.text().c_str());
    std::fflush(stdout);
    csv_.flush();
    last_minute_.clear();
  }

  std::string process_;
  double seconds_;
  std::ofstream csv_;
  std::unique_ptr<io::Participant> graph_ = io::join_graph({});
  std::unique_ptr<io::Subscription> images_in_ = subscribe("/camera/depth/image_rect_raw");
  std::array<std::unique_ptr<io::Subscription>, results> results_in_ = {
      subscribe("/penumbra/labels"), subscribe("/penumbra/filtered_depth")};
  Stalls stalls_;
  std::map<std::int64_t, Frame> waiting_;  // by stamp
  bool begun_ = false;
  std::int64_t first_ = 0, ends_at_ = std::numeric_limits<std::int64_t>::max();
  std::uint64_t missed_before_ = 0;
  std::size_t images_ = 0, stalled_ = 0;
  std::array<std::size_t, results> lost_{}, lost_steady_{};
  std::array<Latencies, results> all_, steady_;  // steady: without frames of stalls
  Latencies last_minute_;                        // of the labels

  [[nodiscard]] std::unique_ptr<io::Subscription> subscribe(const std::string& topic) const {
    return graph_->subscribe(topic, "sensor_msgs/msg/Image",
                             {.reliable = true, .latched = false, .depth = 50});
  }
};

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  try {
    if (argc != 4) throw std::runtime_error("expected PID SECONDS CSV");
    penumbra::bench::Watch(argv[1], std::stod(argv[2]), argv[3]).run();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "live_latency: " << error.what() << '\n';
    return 2;
  }
}
