// SPDX-License-Identifier: Apache-2.0
// The labels that another vendor's subscriber hears, against the truth of their stamps.
#pragma once

#include "../io/live_scene.hpp"
#include "peer_process.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <io/live/latency_histogram.hpp>

namespace penumbra::test {

struct HeardLabels {
  std::uint64_t number = 0;             ///< its writer's sequence number, from 1 on
  std::int64_t stamp = 0, arrival = 0;  ///< nanoseconds since 1970
  std::uint64_t digest = 0;
  bool is_known = false;  ///< not all of it is unknown
};

/// What label images have come to.
struct LabelVerdict {
  std::size_t known = 0, unknown = 0, wrong = 0;
  std::size_t lost_again = 0;       ///< of the unknown, those after the first known
  std::uint64_t newest_number = 0;  ///< the last one's sequence number; 0: none was heard
  bool in_order = true;             ///< each behind the one before it
  std::int64_t first_wrong = 0;     ///< stamp
};

class LabelWatch {
 public:
  LabelWatch(int domain, const LiveLens& lens, const std::string& topic = "/penumbra/labels");
  ~LabelWatch() { end(); }
  LabelWatch(const LabelWatch&) = delete;
  LabelWatch& operator=(const LabelWatch&) = delete;

  /// Waits for the first known labels that came after `arrival` and are stamped after `stamp`: when
  /// they came.
  [[nodiscard]] std::optional<std::int64_t> known_after(std::int64_t arrival, std::int64_t stamp,
                                                        std::chrono::seconds at_most);
  [[nodiscard]] std::size_t known_count();
  /// The sequence number of the last one; 0: none was heard.
  [[nodiscard]] std::uint64_t newest_number();
  void end();

  // After end().
  [[nodiscard]] io::LatencyHistogram latency() const;
  [[nodiscard]] LabelVerdict judge() const;

 private:
  void read();

  LiveLens lens_;
  std::unique_ptr<PeerProcess> process_;
  std::mutex mutex_;
  std::vector<HeardLabels> heard_;  // guarded by mutex_
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace penumbra::test
