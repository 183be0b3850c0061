// SPDX-License-Identifier: Apache-2.0
// Joint states that are late, out of order or lost, and publishers that stop: each label image
// shows the true pose at its stamp, or is all unknown.
#include "../support/random.hpp"
#include "live_scene.hpp"

#include <algorithm>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

struct Event {
  std::int64_t time;  // when it arrives
  std::function<void(LiveBench&)> tell;
};

/// The messages of a camera at 30 Hz and a robot at 100 Hz in `length`, in the order of arrival.
class Script {
 public:
  explicit Script(std::mt19937_64& random) : random_(random) {}

  void write(std::int64_t start, std::int64_t length) {
    for (std::int64_t t = start; t < start + length; t += 10 * milliseconds)
      if (!lost(0.2) && !in_pause(t, joint_pauses_))
        add(t + delay(0, 60), [t](LiveBench& bench) { bench.tell_joints(t); });
    for (std::int64_t t = start; t < start + length; t += 33 * milliseconds) {
      if (in_pause(t, depth_pauses_)) continue;
      add(t + delay(10, 80), [t](LiveBench& bench) { bench.tell_depth(t); });
      if (!lost(0.1)) add(t + delay(10, 80), [t](LiveBench& bench) { bench.tell_info(t); });
    }
  }
  void pause_joints(std::int64_t from, std::int64_t to) { joint_pauses_.push_back({from, to}); }
  void pause_depth(std::int64_t from, std::int64_t to) { depth_pauses_.push_back({from, to}); }
  void add(std::int64_t time, std::function<void(LiveBench&)> tell) {
    events_.push_back({time, std::move(tell)});
  }
  void play(LiveBench& bench) {
    std::stable_sort(events_.begin(), events_.end(),
                     [](const Event& a, const Event& b) { return a.time < b.time; });
    for (const Event& event : events_) {
      for (auto wake = bench.inbox.wake_at(0); wake && *wake < event.time;
           wake = bench.inbox.wake_at(0)) {
        bench.now = std::max(bench.now, *wake);
        if (bench.work() == 0) break;
      }
      bench.now = event.time;
      event.tell(bench);
      bench.work();
    }
    bench.now += seconds;
    bench.work();
  }

 private:
  using Pauses = std::vector<std::pair<std::int64_t, std::int64_t>>;
  bool lost(double share) { return std::bernoulli_distribution(share)(random_); }
  std::int64_t delay(int least, int most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random_) * milliseconds;
  }
  static bool in_pause(std::int64_t time, const Pauses& pauses) {
    return std::any_of(pauses.begin(), pauses.end(), [&](const auto& pause) {
      return pause.first <= time && time < pause.second;
    });
  }

  std::mt19937_64& random_;
  std::vector<Event> events_;
  Pauses joint_pauses_, depth_pauses_;
};

TEST(LiveChaos, NoLabelImageIsOfAWrongPose) {
  for (int round = 0; round < 3; ++round) {
    auto random = seeded_random(static_cast<std::uint64_t>(round));
    Script script(random);
    script.pause_joints(start + 3 * seconds, start + 4 * seconds);
    script.pause_depth(start + 6 * seconds, start + 7 * seconds);
    script.write(start, 10 * seconds);
    LiveBench bench;
    bench.results.wanted = {{io::Result::overlay, false}, {io::Result::points, false}};
    bench.tell_all();
    script.play(bench);
    LiveTruth truth;
    EXPECT_GT(expect_true_labels(bench.results.published, truth), 100U);
    const io::ImageCounts counts = bench.counts();
    std::size_t all = counts.judged + counts.failed + counts.waiting;
    for (const std::size_t dropped : counts.dropped) all += dropped;
    EXPECT_EQ(all, counts.received);
    EXPECT_EQ(counts.failed, 0U);
    // Results resume within a second after the joint states do.
    const bool is_back = std::any_of(bench.results.published.begin(), bench.results.published.end(),
                                     [&](const KeptResults::Published& one) {
                                       return one.result == io::Result::virtual_depth &&
                                              one.stamp > start + 4 * seconds &&
                                              one.stamp < start + 5 * seconds;
                                     });
    EXPECT_TRUE(is_back);
  }
}

TEST(LiveChaos, AClockThatJumpsBackTwice) {
  auto random = seeded_random(9);
  LiveBench bench;
  bench.results.wanted = {{io::Result::overlay, false}, {io::Result::points, false}};
  bench.tell_all();
  LiveTruth truth;
  for (const std::int64_t begin : {start, start - 300 * seconds, start - 450 * seconds}) {
    Script script(random);
    script.write(begin, 3 * seconds);
    bench.results.published.clear();
    bench.now = begin;  // the clock of waits jumps, too
    script.play(bench);
    EXPECT_GT(expect_true_labels(bench.results.published, truth), 30U) << begin;
  }
}

}  // namespace
}  // namespace penumbra::test
