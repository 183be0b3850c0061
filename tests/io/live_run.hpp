// SPDX-License-Identifier: Apache-2.0
// The threads of live with the scene of live_scene.hpp.
#pragma once

#include "live_scene.hpp"

#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include <io/live/live_runner.hpp>

namespace penumbra::test {

/// Waits until `is_so`. Gives up after minutes, which no machine needs.
template <typename IsSo>
bool wait_until(const IsSo& is_so) {
  for (int i = 0; i < 30'000; ++i) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

/// Keeps results of live's threads: those that are wanted.
class SharedResults final : public io::ResultSink {
 public:
  std::set<io::Result> wanted;

  [[nodiscard]] bool wants(io::Result result) const override { return wanted.contains(result); }
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    const std::lock_guard lock(mutex_);
    kept_[result].push_back({result, stamp, {payload.begin(), payload.end()}});
  }
  [[nodiscard]] std::vector<KeptResults::Published> kept(io::Result result) {
    const std::lock_guard lock(mutex_);
    return kept_[result];
  }

 private:
  std::mutex mutex_;
  std::map<io::Result, std::vector<KeptResults::Published>> kept_;
};

/// A runner that receives messages by the names of their topics.
class LiveRun : public io::LiveRunner {
 public:
  template <typename... Arguments>
  explicit LiveRun(Arguments&&... arguments) : LiveRunner(std::forward<Arguments>(arguments)...) {
    with_inbox([&](io::LiveInbox& inbox) {
      topics.assign(inbox.topics().begin(), inbox.topics().end());
      set_types(inbox);
      return true;
    });
  }
  void say(const std::string& name, std::vector<std::byte> payload) {
    const auto owned = std::make_shared<const std::vector<std::byte>>(std::move(payload));
    for (std::size_t i = 0; i < topics.size(); ++i)
      if (topics[i].name == name) receive(i, {*owned, owned});
  }
  void say_robot_and_mount() {
    say("/robot_description", encoded(io::StringMessage{live_urdf}));
    say("/tf_static", live_transform("base", "optical"));
  }
  bool wait_for_robot() {
    return wait_until([&] {
      return with_inbox([](const io::LiveInbox& inbox) { return bool(inbox.robot().posed()); });
    });
  }
  /// Returns the images or clouds that are judged or dropped.
  template <typename Sensor>
  static std::size_t done(const Sensor& sensor) {
    const io::ImageCounts counts = sensor.counts();
    return counts.received - counts.waiting - counts.in_work;
  }

  std::vector<io::InputTopic> topics;
};

}  // namespace penumbra::test
