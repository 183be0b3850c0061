// SPDX-License-Identifier: Apache-2.0
// The threads of live: two cameras and one robot, with all messages at once.
#include "../support/errors.hpp"
#include "live_run.hpp"

#include <atomic>
#include <future>

#include <io/live/live_diagnostics.hpp>

namespace penumbra::test {
namespace {

class LiveRunnerTest : public testing::Test {
 protected:
  LiveRunnerTest() {
    left_.wanted = right_.wanted = {io::Result::labels};
    for (const std::string name : {"left", "right"})
      options_.cameras.push_back({.name = name,
                                  .depth_topic = "/" + name + "/depth",
                                  .info_topic = "/" + name + "/camera_info"});
  }
  void start(const io::LiveRunner::RobotMaker& maker = io::make_robot) {
    std::vector<io::ResultSink*> sinks{&left_, &right_};
    sinks.resize(options_.cameras.size());
    run_ = std::make_unique<LiveRun>(options_, PipelineConfig{}, sinks, maker,
                                     std::chrono::milliseconds(10));
    if (fusion_) run_->fuse(*fusion_);
    run_->start();
    run_->say_robot_and_mount();
  }
  void end() {
    run_->stop();
    EXPECT_FALSE(run_->fault());
  }
  static std::int64_t stamp_of(int i) { return test::start + i * 33 * milliseconds; }

  io::LiveOptions options_;
  SharedResults left_, right_;
  std::unique_ptr<io::LiveFusion> fusion_;
  std::unique_ptr<LiveRun> run_;
};

TEST_F(LiveRunnerTest, JudgesTwoCamerasAtOnce) {
  start();
  for (const char* camera : {"/left", "/right"})
    run_->say(std::string(camera) + "/camera_info", encoded(live_info(0)));
  ASSERT_TRUE(run_->wait_for_robot());
  constexpr std::size_t frames = 60, waits = 6;
  const auto are_done = [&](std::size_t images) {
    return run_->with_inbox([&](const io::LiveInbox& inbox) {
      return LiveRun::done(inbox.camera(0)) == images && LiveRun::done(inbox.camera(1)) == images;
    });
  };
  for (std::size_t i = 0; i < frames; ++i) {
    const std::int64_t stamp = stamp_of(static_cast<int>(i));
    run_->say("/joint_states", live_joints(stamp));
    for (const char* camera : {"/left", "/right"})
      run_->say(std::string(camera) + "/depth", live_depth(stamp));
    if (i % (frames / waits) != frames / waits - 1) continue;
    ASSERT_TRUE(wait_until([&] { return are_done(i + 1); }));
  }
  end();
  LiveTruth truth;
  for (SharedResults* results : {&left_, &right_}) {
    const auto published = results->kept(io::Result::labels);
    EXPECT_GE(expect_true_labels(published, truth), waits);
    EXPECT_EQ(published.back().stamp, stamp_of(frames - 1));
  }
}

TEST_F(LiveRunnerTest, PointsAreAsFewAndAsSeldomAsAsked) {
  options_.cameras.resize(1);
  options_.points = {.stride = 4, .range = 2.0};  // the wall is farther
  options_.points_rate = 1e-6;
  left_.wanted.insert(io::Result::points);
  start();
  run_->say("/left/camera_info", encoded(live_info(0)));
  ASSERT_TRUE(run_->wait_for_robot());
  constexpr std::size_t frames = 5;
  for (std::size_t i = 0; i < frames; ++i) {
    const std::int64_t stamp = stamp_of(static_cast<int>(i));
    for (const int after : {-10, 10})
      run_->say("/joint_states", live_joints(stamp + after * milliseconds));
    run_->say("/left/depth", live_depth(stamp));
    ASSERT_TRUE(wait_until([&] { return left_.kept(io::Result::labels).size() > i; }));
  }
  end();
  EXPECT_EQ(left_.kept(io::Result::labels).size(), frames);
  EXPECT_EQ(left_.kept(io::Result::points).size(), 1U);
  for (const auto& one : left_.kept(io::Result::points))
    EXPECT_EQ(decoded<io::PointCloud2Message>(one.payload).width, 0U)
        << "robot and wall are left out";
}

TEST_F(LiveRunnerTest, ARobotWhoseMeshesComeLaterHealsByItself) {
  std::atomic<int> tries = 0;
  start([&](const io::RobotLoadRequest& request) {
    if (++tries < 3) return io::MadeRobot{request.number, nullptr, "its meshes are not there"};
    return io::make_robot(request);
  });
  EXPECT_TRUE(run_->wait_for_robot());
  EXPECT_EQ(tries, 3);
  end();
}

TEST_F(LiveRunnerTest, ReceivesWhileARobotsMeshesAreRead) {
  std::promise<void> begun, may_go_on;
  start([&](const io::RobotLoadRequest& request) {
    begun.set_value();
    may_go_on.get_future().wait();
    return io::make_robot(request);
  });
  run_->say("/left/camera_info", encoded(live_info(0)));
  begun.get_future().wait();
  const auto say_image = [&](std::int64_t stamp) {
    run_->say("/joint_states", live_joints(stamp));
    run_->say("/left/depth", live_depth(stamp));
  };
  for (int i = 0; i < 10; ++i) say_image(stamp_of(i));
  const std::vector<io::LiveLink> links(run_->topics.size());
  run_->with_inbox([&](const io::LiveInbox& inbox) {
    EXPECT_TRUE(inbox.robot().is_being_made());
    EXPECT_EQ(inbox.camera(0).counts().of(DropReason::not_ready), 10U);
    const auto fault = io::robot_fault(inbox, links, io::LiveRunner::steady_now());
    EXPECT_TRUE(holds(fault.why, "is being made"));
    return true;
  });
  may_go_on.set_value();
  ASSERT_TRUE(run_->wait_for_robot());
  int i = 10;
  EXPECT_TRUE(wait_until([&] {
    say_image(stamp_of(i++));
    return !left_.kept(io::Result::labels).empty();
  }));
  end();
  LiveTruth truth;
  EXPECT_GT(expect_true_labels(left_.kept(io::Result::labels), truth), 0U);
}

// A point 2 m before the left camera, behind the board, and beside the board for the right one.
TEST_F(LiveRunnerTest, CamerasGiveOneVerdict) {
  using Views = io::TargetViewsMessage;
  options_.target_topics = {"/part"};
  std::mutex mutex;
  std::vector<Views> told;
  fusion_ = std::make_unique<io::LiveFusion>(std::vector<std::string>{"left", "right"},
                                             [&](std::span<const std::byte> payload) {
                                               const std::lock_guard lock(mutex);
                                               told.push_back(decoded<Views>(payload));
                                             });
  const auto last = [&] {
    const std::lock_guard lock(mutex);
    return told.empty() ? Views() : told.back();
  };
  start();
  ASSERT_TRUE(run_->wait_for_robot());
  run_->say("/tf_static", live_transform("base", "aside", {0.8, 0, 0}));
  io::CameraInfoMessage info = live_info(0);
  run_->say("/left/camera_info", encoded(info));
  info.header.frame_id = "aside";
  run_->say("/right/camera_info", encoded(info));
  const Image<std::uint16_t> board(64, 48, 950), behind(64, 48, 2000);
  std::int64_t stamp = test::start;
  /// Judges frames until `is_done`.
  const auto judge_until = [&](bool with_right, const auto& is_done) {
    Views views;
    EXPECT_TRUE(wait_until([&] {
      stamp += 20 * milliseconds;
      run_->say("/part", live_target(stamp, {0, 0, 2}, "base"));
      run_->say("/left/depth", encoded(io::image_message(io::MessageHeader{stamp, "optical"},
                                                         "16UC1", board.view())));
      if (with_right)
        run_->say("/right/depth", encoded(io::image_message(io::MessageHeader{stamp, "aside"},
                                                            "16UC1", behind.view())));
      for (const int later : {-10, 10})
        run_->say("/joint_states", live_joints(stamp + later * milliseconds));
      views = last();
      return is_done(views);
    }));
    return views;
  };
  const Views both = judge_until(true, [](const Views& views) {
    return !views.targets.empty() && views.targets[0].verdict == io::TargetMessage::visible &&
           views.targets[0].views.size() == 2 &&
           views.targets[0].views[0].verdict == io::TargetMessage::hidden;
  });
  ASSERT_EQ(both.targets.size(), 1U);
  EXPECT_EQ(both.header.frame_id, "base");
  EXPECT_EQ(both.targets[0].best, "right");
  const Views left = judge_until(false, [](const Views& views) {
    return !views.targets.empty() && views.targets[0].verdict == io::TargetMessage::unknown &&
           holds(views.targets[0].reason, "'right'");
  });
  EXPECT_EQ(left.targets.size(), 1U) << "the right camera is silent";
  io::DiagnosticArrayMessage diagnostics{.header = {}, .status = {{}}};
  fusion_->add_contradictions(diagnostics);
  EXPECT_TRUE(diagnostics.status[0].values.empty());
  end();
}

}  // namespace
}  // namespace penumbra::test
