// SPDX-License-Identifier: Apache-2.0
// The threads of live: two cameras and one robot, with all messages at once.
#include "live_scene.hpp"

#include <algorithm>
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
    return result == io::Result::labels || (with_points && result == io::Result::points);
  }
  void write(io::Result result, std::int64_t stamp, std::span<const std::byte> payload) override {
    const std::lock_guard lock(mutex_);
    results_.write(result, stamp, payload);
  }
  [[nodiscard]] std::size_t count(io::Result of) {
    const auto all = published();
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](const auto& one) { return one.result == of; }));
  }
  [[nodiscard]] std::vector<KeptResults::Published> published() {
    const std::lock_guard lock(mutex_);
    return results_.published;
  }

  bool with_points = false;

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

TEST_F(LiveRunnerTest, PointsAreAsFewAndAsSeldomAsAsked) {
  options_.cameras.resize(1);
  options_.points = {.stride = 4, .range = 2.0};  // the wall is farther
  options_.points_rate = 0.01;
  left_.with_points = true;
  io::LiveRunner runner(options_, {}, {&left_});
  const auto topics = topics_of(runner);
  runner.start();
  tell(runner, topics, "/robot_description", encoded(io::StringMessage{live_urdf}));
  tell(runner, topics, "/tf_static", encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
  tell(runner, topics, "/left/camera_info", encoded(live_info(0)));
  for (int wait = 0; wait < 1000; ++wait) {
    if (runner.with_inbox([](const io::LiveInbox& inbox) { return bool(inbox.robot().posed()); }))
      break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  constexpr std::size_t frames = 5;
  for (std::size_t i = 0; i < frames; ++i) {
    const std::int64_t stamp = 1000 * seconds + static_cast<std::int64_t>(i) * 33 * milliseconds;
    for (const int after : {-10, 10})
      tell(runner, topics, "/joint_states", live_joints(stamp + after * milliseconds));
    tell(runner, topics, "/left/depth", live_depth(stamp));
    for (int wait = 0; wait < 1000 && left_.count(io::Result::labels) <= i; ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  runner.stop();
  EXPECT_EQ(left_.count(io::Result::labels), frames);
  EXPECT_EQ(left_.count(io::Result::points), 1U);
  for (const auto& one : left_.published()) {
    if (one.result != io::Result::points) continue;
    io::PointCloud2Message cloud;
    ASSERT_FALSE(io::Decoder<io::PointCloud2Message>().decode(one.payload, cloud));
    EXPECT_EQ(cloud.width, 0U) << "robot and wall are left out";
  }
}

TEST_F(LiveRunnerTest, ARobotWhoseMeshesComeLaterHealsByItself) {
  std::atomic<int> tries = 0;
  const auto maker = [&](const io::RobotLoadRequest& request) {
    if (++tries < 3) return io::MadeRobot{request.number, nullptr, "its meshes are not there"};
    return io::make_robot(request);
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
  io::LiveRunner runner(options_, {}, {&left_, &right_}, [&](const io::RobotLoadRequest& request) {
    begun.set_value();
    may_go_on.get_future().wait();
    return io::make_robot(request);
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
    EXPECT_EQ(inbox.camera(0).counts().of(DropReason::not_ready), 10U);
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

// A point 2 m before the left camera, behind the board, and beside the board for the right one.
TEST_F(LiveRunnerTest, CamerasGiveOneVerdict) {
  using Views = io::TargetViewsMessage;
  options_.target_topics = {"/part"};
  std::mutex mutex;
  std::vector<Views> told;
  io::LiveFusion fusion({"left", "right"}, [&](std::span<const std::byte> payload) {
    const std::lock_guard lock(mutex);
    const auto fault = io::Decoder<Views>().decode(payload, told.emplace_back());
    EXPECT_FALSE(fault) << *fault;
  });
  const auto last = [&] {
    const std::lock_guard lock(mutex);
    return told.empty() ? Views() : told.back();
  };
  io::LiveRunner runner(options_, {}, {&left_, &right_});
  runner.fuse(fusion);
  runner.with_inbox([&](io::LiveInbox& inbox) {
    for (std::size_t i = 0; i < inbox.topics().size(); ++i)
      if (inbox.topics()[i].name == "/part") inbox.set_type(i, "geometry_msgs/msg/PoseStamped");
    return true;
  });
  const auto topics = topics_of(runner);
  runner.start();
  const auto say = [&](const std::string& name, std::vector<std::byte> payload) {
    tell(runner, topics, name, std::move(payload));
  };
  const Eigen::Isometry3d aside(Eigen::Translation3d(0.8, 0.0, 0.0));
  say("/robot_description", encoded(io::StringMessage{live_urdf}));
  say("/tf_static",
      encoded(io::TfMessage{{{{0, "base"}, "optical"}, {{0, "base"}, "aside", aside}}}));
  io::CameraInfoMessage info = live_info(0);
  say("/left/camera_info", encoded(info));
  info.header.frame_id = "aside";
  say("/right/camera_info", encoded(info));
  const Image<std::uint16_t> board(64, 48, 950), behind(64, 48, 2000);
  std::int64_t stamp = start;
  /// Judges frames until `is_done`, or for 10 s.
  const auto judge_until = [&](bool with_right, const auto& is_done) {
    for (int i = 0; i < 1000 && !is_done(last()); ++i, stamp += 20 * milliseconds) {
      io::PoseStampedMessage part{.header = {stamp, "base"}};
      part.pose.translation() = Eigen::Vector3d(0.0, 0.0, 2.0);
      say("/part", encoded(part));
      say("/left/depth",
          encoded(io::image_message(io::MessageHeader{stamp, "optical"}, "16UC1", board.view())));
      if (with_right)
        say("/right/depth",
            encoded(io::image_message(io::MessageHeader{stamp, "aside"}, "16UC1", behind.view())));
      for (const int later : {-10, 10})
        say("/joint_states", live_joints(stamp + later * milliseconds));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return last();
  };
  const auto has_verdict = [](std::uint8_t verdict) {
    return [verdict](const Views& views) {
      return !views.targets.empty() && views.targets[0].views.size() == 2 &&
             views.targets[0].verdict == verdict;
    };
  };
  const Views both = judge_until(true, has_verdict(io::TargetMessage::visible));
  ASSERT_EQ(both.targets.size(), 1U);
  EXPECT_EQ(both.header.frame_id, "base");
  EXPECT_EQ(both.targets[0].best, "right");
  EXPECT_EQ(both.targets[0].verdict, io::TargetMessage::visible) << both.targets[0].reason;
  EXPECT_EQ(both.targets[0].views.at(0).verdict, io::TargetMessage::hidden);
  const Views left = judge_until(false, has_verdict(io::TargetMessage::unknown));
  ASSERT_EQ(left.targets.size(), 1U);
  EXPECT_EQ(left.targets[0].verdict, io::TargetMessage::unknown) << "the right camera is silent";
  EXPECT_NE(left.targets[0].reason.find("'right'"), std::string::npos) << left.targets[0].reason;
  io::DiagnosticArrayMessage diagnostics{.header = {}, .status = {{}}};
  fusion.add_contradictions(diagnostics);
  EXPECT_TRUE(diagnostics.status[0].values.empty());
  runner.stop();
  EXPECT_FALSE(runner.fault());
}

}  // namespace
}  // namespace penumbra::test
