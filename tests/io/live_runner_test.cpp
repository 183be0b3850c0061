// SPDX-License-Identifier: Apache-2.0
// The threads of live: two cameras, one robot, everything told at once.
#include "live_scene.hpp"

#include <chrono>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include <io/live/live_runner.hpp>

namespace penumbra::test {
namespace {

/// Results that another thread may look at.
class SharedResults final : public io::ResultSink {
 public:
  [[nodiscard]] bool wants(io::Result result) const override {
    return result == io::Result::labels;
  }
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    const std::lock_guard lock(mutex_);
    results_.write(result, stamp, payload);
  }
  [[nodiscard]] std::vector<KeptResults::Told> told() {
    const std::lock_guard lock(mutex_);
    return results_.told;
  }

 private:
  std::mutex mutex_;
  KeptResults results_;
};

class LiveRunnerTest : public testing::Test {
 protected:
  LiveRunnerTest() {
    for (const char* name : {"left", "right"})
      options_.cameras.push_back({.name = name,
                                  .depth_topic = std::string("/") + name + "/depth",
                                  .info_topic = std::string("/") + name + "/camera_info"});
  }
  static void tell(io::LiveRunner& runner, const std::vector<io::LiveTopic>& topics,
                   const std::string& name, std::vector<std::byte> payload) {
    const auto owned = std::make_shared<const std::vector<std::byte>>(std::move(payload));
    for (std::size_t i = 0; i < topics.size(); ++i)
      if (topics[i].name == name) runner.receive(i, {*owned, owned});
  }
  io::LiveOptions options_;
  SharedResults left_, right_;
};

TEST_F(LiveRunnerTest, JudgesTwoCamerasAtOnce) {
  io::LiveRunner runner(options_, {}, {&left_, &right_});
  const auto topics = runner.with_inbox([](const io::LiveInbox& inbox) {
    return std::vector<io::LiveTopic>(inbox.topics().begin(), inbox.topics().end());
  });
  runner.start();
  const auto say = [&](const std::string& name, std::vector<std::byte> payload) {
    tell(runner, topics, name, std::move(payload));
  };
  say("/robot_description", encoded(io::StringMessage{live_urdf}));
  say("/tf_static", encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
  for (const char* camera : {"/left", "/right"})
    say(std::string(camera) + "/camera_info", encoded(live_info(0)));
  constexpr int frames = 60;
  for (int i = 0; i < frames; ++i) {
    const std::int64_t stamp = 1000 * seconds + i * 33 * milliseconds;
    say("/joint_states", live_joints(stamp));
    for (const char* camera : {"/left", "/right"})
      say(std::string(camera) + "/depth", live_depth(stamp));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const auto all_done = [&] {
    return runner.with_inbox([](const io::LiveInbox& inbox) {
      bool done = true;
      for (std::size_t i = 0; i < inbox.camera_count(); ++i) {
        const io::LiveCounts counts = inbox.camera(i).counts();
        done &= counts.waiting == 0 && counts.in_work == 0;
      }
      return done;
    });
  };
  for (int i = 0; i < 1000 && !all_done(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(all_done());
  runner.stop();
  EXPECT_FALSE(runner.fault());
  LiveTruth truth;
  for (SharedResults* results : {&left_, &right_}) {
    const auto told = results->told();
    EXPECT_GT(expect_true_labels(told, truth), 0U);
    EXPECT_EQ(told.back().stamp, 1000 * seconds + (frames - 1) * 33 * milliseconds);
  }
}

TEST_F(LiveRunnerTest, EndsAtOnce) {
  io::LiveRunner runner(options_, {}, {&left_, &right_});
  runner.start();
  runner.stop();
  EXPECT_FALSE(runner.has_failed());
}

}  // namespace
}  // namespace penumbra::test
