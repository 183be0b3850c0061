// SPDX-License-Identifier: Apache-2.0
// The threads of live: two cameras and one robot, with all messages at once.
#include "live_scene.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include <io/live/live_diagnostics.hpp>
#include <io/live/live_runner.hpp>

namespace penumbra::test {
namespace {

/// Results that another thread may read.
class SharedResults final : public io::ResultSink {
 public:
  [[nodiscard]] bool wants(io::Result result) const override {
    return result == io::Result::labels;
  }
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    const std::lock_guard lock(mutex_);
    results_.write(result, stamp, payload);
  }
  [[nodiscard]] std::vector<KeptResults::Published> published() {
    const std::lock_guard lock(mutex_);
    return results_.published;
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
  static std::vector<io::InputTopic> topics_of(io::LiveRunner& runner) {
    return runner.with_inbox([](const io::LiveInbox& inbox) {
      return std::vector<io::InputTopic>(inbox.topics().begin(), inbox.topics().end());
    });
  }
  static void tell(io::LiveRunner& runner, const std::vector<io::InputTopic>& topics,
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
  const auto topics = topics_of(runner);
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
        const io::ImageCounts counts = inbox.camera(i).counts();
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
    const auto published = results->published();
    EXPECT_GT(expect_true_labels(published, truth), 0U);
    EXPECT_EQ(published.back().stamp, 1000 * seconds + (frames - 1) * 33 * milliseconds);
  }
}

TEST_F(LiveRunnerTest, ARobotWhoseMeshesComeLaterHealsByItself) {
  std::atomic<int> tries = 0;
  const auto maker = [&](const io::RobotOrder& order) {
    if (++tries < 3) return io::MadeRobot{order.number, nullptr, "its meshes are not there"};
    return io::make_robot(order);
  };
  io::LiveRunner runner(options_, {}, {&left_, &right_}, maker, std::chrono::milliseconds(10));
  const auto topics = topics_of(runner);
  runner.start();
  tell(runner, topics, "/robot_description", encoded(io::StringMessage{live_urdf}));
  const auto is_there = [&] {
    return runner.with_inbox(
        [](const io::LiveInbox& inbox) { return bool(inbox.robot().posed()); });
  };
  for (int i = 0; i < 1000 && !is_there(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(is_there());
  EXPECT_EQ(tries, 3);
}

TEST_F(LiveRunnerTest, ReceivesWhileARobotsMeshesAreRead) {
  std::promise<void> begun, may_go_on;
  io::LiveRunner runner(options_, {}, {&left_, &right_}, [&](const io::RobotOrder& order) {
    begun.set_value();
    may_go_on.get_future().wait();
    return io::make_robot(order);
  });
  const auto topics = topics_of(runner);
  runner.start();
  const auto say = [&](const std::string& name, std::vector<std::byte> payload) {
    tell(runner, topics, name, std::move(payload));
  };
  say("/tf_static", encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
  say("/left/camera_info", encoded(live_info(0)));
  say("/robot_description", encoded(io::StringMessage{live_urdf}));
  begun.get_future().wait();
  const std::int64_t start = 1000 * seconds;
  for (int i = 0; i < 10; ++i) {
    say("/joint_states", live_joints(start + i * 10 * milliseconds));
    say("/left/depth", live_depth(start + i * 10 * milliseconds));
  }
  const std::vector<io::LiveLink> links(topics.size());
  runner.with_inbox([&](const io::LiveInbox& inbox) {
    EXPECT_TRUE(inbox.robot().is_being_made());
    EXPECT_EQ(inbox.camera(0).counts().of(io::FrameDrop::not_ready), 10U);
    const auto fault = io::robot_fault(inbox, links, io::LiveRunner::steady_now());
    EXPECT_NE(fault.why.find("is being made"), std::string::npos) << fault.why;
    return true;
  });
  may_go_on.set_value();
  LiveTruth truth;
  for (int i = 0; i < 1000 && left_.published().empty(); ++i) {
    const std::int64_t stamp = start + seconds + i * 10 * milliseconds;
    say("/joint_states", live_joints(stamp));
    say("/left/depth", live_depth(stamp));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  runner.stop();
  EXPECT_FALSE(runner.fault());
  EXPECT_GT(expect_true_labels(left_.published(), truth), 0U);
}

}  // namespace
}  // namespace penumbra::test
