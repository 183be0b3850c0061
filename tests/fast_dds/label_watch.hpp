// SPDX-License-Identifier: Apache-2.0
// The labels that another vendor's subscriber hears, against the truth of their stamps.
#pragma once

#include "../io/live_scene.hpp"
#include "pattern.hpp"
#include "peer_process.hpp"

#include <atomic>
#include <functional>
#include <mutex>
#include <sstream>
#include <thread>

namespace penumbra::test {

struct HeardLabels {
  std::uint64_t number = 0;  ///< its writer's sequence number, from 1 on
  std::int64_t stamp = 0;    ///< nanoseconds since 1970
  std::uint64_t digest = 0;
  bool is_known = false;  ///< not all of it is unknown
};

/// What label images have come to.
struct LabelVerdict {
  std::size_t known = 0, unknown = 0, wrong = 0;
  std::size_t lost_again = 0;    ///< of the unknown, those after the first known
  bool in_order = true;          ///< each behind the one before it
  std::int64_t first_wrong = 0;  ///< stamp
};

class LabelWatch {
 public:
  LabelWatch(int domain, const LiveLens& lens, const std::string& topic = "/penumbra/labels")
      : lens_(lens),
        process_(make_peer(domain, {"watch", "rt" + topic, "sensor_msgs::msg::dds_::Image_",
                                    "reliable,depth=50"})),
        thread_([this] { read(); }) {}
  ~LabelWatch() { end(); }
  LabelWatch(const LabelWatch&) = delete;
  LabelWatch& operator=(const LabelWatch&) = delete;

  /// Waits for known labels that are stamped after `stamp`; false: in vain.
  [[nodiscard]] bool known_after(std::int64_t stamp, std::chrono::seconds at_most) {
    const auto end = std::chrono::steady_clock::now() + at_most;
    do {
      {
        const std::lock_guard lock(mutex_);
        if (std::ranges::any_of(
                heard_, [&](const HeardLabels& one) { return one.is_known && one.stamp > stamp; }))
          return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }
  [[nodiscard]] std::size_t known_count() {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(heard_, &HeardLabels::is_known));
  }
  /// The sequence number of the last one; 0: none was heard.
  [[nodiscard]] std::uint64_t newest_number() {
    const std::lock_guard lock(mutex_);
    return heard_.empty() ? 0 : heard_.back().number;
  }
  void end() {
    if (!thread_.joinable()) return;
    ends_ = true;
    process_->end();
    thread_.join();
  }

  /// After end().
  [[nodiscard]] LabelVerdict judge() const {
    LabelVerdict all;
    LiveTruth truth(lens_);
    for (const HeardLabels& one : heard_) {
      ++(one.is_known ? all.known : all.unknown);
      if (!one.is_known ||
          digest_of(message_of(one.stamp, truth.judge(one.stamp).labels)) == one.digest)
        continue;
      ++all.wrong;
      all.first_wrong = one.stamp;
    }
    const auto first = std::ranges::find_if(heard_, &HeardLabels::is_known);
    all.lost_again = static_cast<std::size_t>(
        std::ranges::count(first, heard_.end(), false, &HeardLabels::is_known));
    all.in_order = std::ranges::adjacent_find(heard_, std::ranges::greater_equal(),
                                              &HeardLabels::number) == heard_.end();
    return all;
  }

 private:
  static std::vector<std::byte> message_of(std::int64_t stamp,
                                           ImageView<const std::uint8_t> labels) {
    return encoded(io::image_message(io::MessageHeader{stamp, "optical"}, "8UC1", labels));
  }
  void read() {
    const Image<std::uint8_t> nothing(lens_.width, lens_.height,
                                      static_cast<std::uint8_t>(Label::unknown));
    std::vector<std::byte> unknown = message_of(1, nothing.view());
    while (!ends_) {
      const auto line = process_->line();
      if (!line) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // it ended, or is silent
        continue;
      }
      HeardLabels heard;
      std::istringstream(*line) >> heard.number >> heard.stamp >> heard.digest;
      set_stamp(unknown, heard.stamp);
      heard.is_known = heard.digest != digest_of(unknown);
      const std::lock_guard lock(mutex_);
      heard_.push_back(heard);
    }
  }

  LiveLens lens_;
  std::unique_ptr<PeerProcess> process_;
  std::mutex mutex_;
  std::vector<HeardLabels> heard_;  // guarded by mutex_
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace penumbra::test
