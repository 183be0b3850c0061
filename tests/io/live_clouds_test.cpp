// SPDX-License-Identifier: Apache-2.0
// Live clouds: a lidar that sees the turning board before a wall, each point when it was measured.
#include "live_scene.hpp"

#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include <io/live/cloud_text.hpp>
#include <io/live/live_diagnostics.hpp>
#include <io/live/live_runner.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t scan_time = 100 * milliseconds;
constexpr float wall = 3.0F, board_face = 0.95F;

/// How far a ray, at the board's face, is inside the board's outline at a stamp; negative: outside.
double inside_board(double x, double y, std::int64_t stamp) {
  const double angle = spin_at(stamp), c = std::cos(angle), s = std::sin(angle);
  const double u = c * x + s * y, v = -s * x + c * y;
  return std::min(0.2 - std::abs(u), 0.1 - std::abs(v));
}

/// A scan of rays in a grid, one after the other: x y z, and the time of each in seconds.
struct LidarScan {
  static constexpr int side = 60;
  static constexpr std::uint32_t point_size = 16;

  explicit LidarScan(std::int64_t stamp) : data(side * side * point_size) {
    for (int i = 0; i < side * side; ++i) {
      const int row = i / side, column = i % side;
      const double x = board_face * (column - 29.5) / 100, y = board_face * (row - 29.5) / 100;
      const std::int64_t after = scan_time * i / (side * side);
      const bool on_board = inside_board(x, y, stamp + after) > 0;
      const float range = (on_board ? board_face : wall) / board_face;
      const float point[4] = {static_cast<float>(x) * range, static_cast<float>(y) * range,
                              board_face * range, static_cast<float>(after) * 1e-9F};
      std::memcpy(data.data() + i * static_cast<int>(point_size), point, sizeof point);
    }
    message = {.header = {stamp, "optical"},
               .height = 1,
               .width = side * side,
               .fields = {{"x", 0}, {"y", 4}, {"z", 8}, {"time", 12}},
               .point_step = point_size,
               .row_step = side * side * point_size,
               .data = data};
  }
  std::vector<std::byte> data;
  io::PointCloud2Message message;
};

/// Points of a labelled cloud whose label is wrong, more than 1 cm from the board's rim: poses are
/// looked up so that no link moves by more meanwhile.
std::size_t wrong_labels(const io::PointCloud2Message& cloud) {
  constexpr double rim = 0.01;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.width; ++i) {
    const std::byte* const at = cloud.data.data() + i * cloud.point_step;
    float p[4];
    std::memcpy(p, at, sizeof p);
    const double scale = board_face / p[2];
    const double inside = inside_board(
        p[0] * scale, p[1] * scale,
        cloud.header.stamp + static_cast<std::int64_t>(static_cast<double>(p[3]) * 1e9));
    if (std::abs(inside) < rim) continue;
    const auto label = static_cast<Label>(at[LidarScan::point_size]);
    wrong += label != (inside > 0 ? Label::occluded : Label::clear) ? 1 : 0;
  }
  return wrong;
}

/// Keeps what is published of a sensor.
class KeptClouds final : public io::CloudSink {
 public:
  [[nodiscard]] bool wants(io::CloudResult /*result*/, const std::string& /*type*/) override {
    return true;
  }
  void write(io::CloudResult result, std::span<const std::byte> payload) override {
    const std::lock_guard lock(mutex_);
    kept_[result].emplace_back(payload.begin(), payload.end());
  }
  [[nodiscard]] std::vector<std::vector<std::byte>> kept(io::CloudResult result) {
    const std::lock_guard lock(mutex_);
    return kept_[result];
  }

 private:
  std::mutex mutex_;
  std::map<io::CloudResult, std::vector<std::vector<std::byte>>> kept_;
};

/// Counts the scans that a page would show.
class ScanWatcher final : public io::FrameWatcher {
 public:
  [[nodiscard]] bool wants_color() const override { return false; }
  void take(const io::AssembledFrame& /*job*/, const DepthView& /*depth*/,
            const FrameReport& /*report*/, const Drift& /*drift*/) override {
    ADD_FAILURE() << "there is no camera";
  }
  void take_cloud(const io::ReceivedCloud& cloud, const CloudReport& report) override {
    EXPECT_EQ(report.labels.size(), cloud.points.points.count);
    EXPECT_TRUE(report.status != FrameStatus::ok || report.T_sensor_link.size() == 2);
    ++scans;
  }
  std::size_t scans = 0;
};

class LiveClouds : public testing::Test {
 protected:
  void start(const std::string& text = "/points") {
    options_.clouds = {io::parse_cloud(text)};
    options_.clouds[0].has_targets = !options_.target_topics.empty();
    runner_ = std::make_unique<io::LiveRunner>(
        options_, PipelineConfig{}, std::vector<io::ResultSink*>{}, io::make_robot,
        std::chrono::seconds(5), std::vector<io::CloudSink*>{&kept_});
    runner_->with_inbox([&](io::LiveInbox& inbox) {
      topics_.assign(inbox.topics().begin(), inbox.topics().end());
      for (std::size_t i = 0; i < topics_.size(); ++i)
        if (topics_[i].role == io::TopicRole::cloud)
          inbox.set_type(i, io::message_type<io::PointCloud2Message>());
        else if (topics_[i].role == io::TopicRole::targets)
          inbox.set_type(i, io::message_type<io::PoseStampedMessage>());
      return true;
    });
    runner_->watch_cloud(0, watcher_);
    runner_->start();
    say("/robot_description", encoded(io::StringMessage{live_urdf}));
    say("/tf_static", encoded(io::TfMessage{{{{0, "base"}, "optical"}}}));
    ASSERT_TRUE(eventually([](const io::LiveInbox& inbox) { return bool(inbox.robot().posed()); }));
  }
  void say(const std::string& name, std::vector<std::byte> payload) {
    const auto owned = std::make_shared<const std::vector<std::byte>>(std::move(payload));
    for (std::size_t i = 0; i < topics_.size(); ++i)
      if (topics_[i].name == name) runner_->receive(i, {*owned, owned});
  }
  /// Says joint states, every 10 ms of them, and a scan each 100 ms.
  void scan(int scans, std::int64_t begin = test::start) {
    for (int i = 0; i < scans; ++i) {
      const std::int64_t stamp = begin + i * scan_time;
      for (std::int64_t t = 0; t <= scan_time; t += 10 * milliseconds)
        say("/joint_states", live_joints(stamp + t));
      const std::size_t before = done();
      say("/points", encoded(LidarScan(stamp).message));
      for (int wait = 0; wait < 500 && done() == before; ++wait)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  /// Clouds that are labelled or dropped.
  std::size_t done() {
    return runner_->with_inbox([](const io::LiveInbox& inbox) {
      const io::ImageCounts counts = inbox.cloud(0).counts();
      return counts.received - counts.waiting - counts.in_work;
    });
  }
  template <typename IsSo>
  bool eventually(const IsSo& is_so) {
    for (int i = 0; i < 500; ++i) {
      if (runner_->with_inbox([&](const io::LiveInbox& inbox) { return is_so(inbox); }))
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  io::LiveFault fault() {
    std::vector<io::LiveLink> links(topics_.size());
    for (io::LiveLink& link : links) link.is_open = true;
    return runner_->with_inbox([&](const io::LiveInbox& inbox) {
      return io::cloud_fault(inbox, 0, links, io::LiveRunner::steady_now());
    });
  }
  static io::PointCloud2Message decoded(const std::vector<std::byte>& payload) {
    io::PointCloud2Message cloud;
    const auto fault = io::Decoder<io::PointCloud2Message>().decode(payload, cloud);
    EXPECT_FALSE(fault) << *fault;
    return cloud;
  }

  io::LiveOptions options_;
  KeptClouds kept_;
  ScanWatcher watcher_;
  std::vector<io::InputTopic> topics_;
  std::unique_ptr<io::LiveRunner> runner_;
};

TEST_F(LiveClouds, FollowTheRobotThroughEachScan) {
  start();
  scan(5);
  runner_->stop();
  EXPECT_FALSE(runner_->fault());
  const auto labelled = kept_.kept(io::CloudResult::labelled),
             clean = kept_.kept(io::CloudResult::without_robot);
  ASSERT_EQ(labelled.size(), 5U);
  ASSERT_EQ(clean.size(), 5U);
  for (std::size_t i = 0; i < labelled.size(); ++i) {
    EXPECT_EQ(wrong_labels(decoded(labelled[i])), 0U) << "scan " << i;
    const io::PointCloud2Message cloud = decoded(clean[i]);
    EXPECT_EQ(cloud.header.frame_id, "optical");
    std::size_t on_wall = 0;
    for (std::size_t p = 0; p < cloud.width; ++p) {
      float z = 0;
      std::memcpy(&z, cloud.data.data() + p * cloud.point_step + 8, sizeof z);
      on_wall += z == wall ? 1 : 0;
    }
    EXPECT_GT(on_wall, 1000U);
  }
}

TEST_F(LiveClouds, OfOnePoseAreWrongWhereTheRobotMoved) {
  start("/points ignore_times");
  scan(2);
  runner_->stop();
  ASSERT_EQ(kept_.kept(io::CloudResult::labelled).size(), 2U);
  EXPECT_GT(wrong_labels(decoded(kept_.kept(io::CloudResult::labelled)[1])), 50U);
}

TEST_F(LiveClouds, JudgeTheTargetsOfTheirStampThatComeLater) {
  options_.target_topics = {"/knob"};
  start();
  scan(3);
  const auto say_knob = [&](std::int64_t stamp) {
    io::PoseStampedMessage knob{.header = {stamp, "optical"}};
    knob.pose.translation() = Eigen::Vector3d(0, 0, 1.2);  // the board hides it at any angle
    say("/knob", encoded(knob));
  };
  say_knob(test::start + scan_time);  // the second of three scans
  ASSERT_TRUE(eventually(
      [&](const io::LiveInbox&) { return !kept_.kept(io::CloudResult::targets).empty(); }));
  say_knob(test::start + scan_time / 2);  // of no scan
  runner_->stop();
  const auto kept = kept_.kept(io::CloudResult::targets);
  ASSERT_EQ(kept.size(), 1U);
  io::TargetsMessage targets;
  ASSERT_FALSE(io::Decoder<io::TargetsMessage>().decode(kept[0], targets));
  EXPECT_EQ(targets.header.stamp, test::start + scan_time);
  ASSERT_EQ(targets.targets.size(), 1U);
  EXPECT_EQ(targets.targets[0].name, "/knob");
  EXPECT_EQ(targets.targets[0].verdict, io::TargetMessage::hidden) << targets.targets[0].reason;
  ASSERT_FALSE(targets.targets[0].blame.empty());
  EXPECT_EQ(targets.targets[0].blame[0].link, "board");
  EXPECT_EQ(kept_.kept(io::CloudResult::labelled).size(), 3U) << "each cloud comes once";
  EXPECT_EQ(watcher_.scans, 3U);
}

TEST_F(LiveClouds, GoOnWithTargetsAfterTheClockJumpedBack) {
  options_.target_topics = {"/knob"};
  start();
  scan(2, test::start + 100 * seconds);
  scan(2);  // 100 s earlier
  io::PoseStampedMessage knob{.header = {test::start + scan_time, "optical"}};
  knob.pose.translation() = Eigen::Vector3d(0, 0, 1.2);
  say("/knob", encoded(knob));
  EXPECT_TRUE(eventually(
      [&](const io::LiveInbox&) { return !kept_.kept(io::CloudResult::targets).empty(); }));
}

TEST_F(LiveClouds, WithoutJointStatesAreUnknownAndSaySo) {
  start();
  say("/points", encoded(LidarScan(test::start).message));
  ASSERT_TRUE(
      eventually([](const io::LiveInbox& inbox) { return inbox.cloud(0).counts().judged == 1; }));
  EXPECT_EQ(decoded(kept_.kept(io::CloudResult::without_robot).at(0)).width, 0U);
  EXPECT_NE(fault().why.find("missing_joints"), std::string::npos) << fault().why;
}

TEST_F(LiveClouds, InAFrameAboveTheRobotAreRefused) {
  start();
  say("/tf_static", encoded(io::TfMessage{{{{0, "odom"}, "base"}}}));
  LidarScan scan(test::start);
  scan.message.header.frame_id = "odom";
  say("/points", encoded(scan.message));
  EXPECT_NE(fault().why.find("above the robot"), std::string::npos) << fault().why;
  EXPECT_EQ(done(), 1U);
  EXPECT_TRUE(kept_.kept(io::CloudResult::without_robot).empty());
}

TEST_F(LiveClouds, ThatCannotBeReadAreCountedWithTheReason) {
  start();
  LidarScan scan(test::start);
  scan.message.fields[2].name = "w";
  say("/points", encoded(scan.message));
  const auto [dropped, why] = runner_->with_inbox([](const io::LiveInbox& inbox) {
    const auto& faults = inbox.faults().all();
    return std::pair(inbox.cloud(0).counts().of(DropReason::unreadable),
                     faults.empty() ? std::string() : faults.begin()->second.what);
  });
  EXPECT_EQ(dropped, 1U);
  EXPECT_NE(why.find('z'), std::string::npos) << why;
}

TEST(CloudText, SaysWhatASensorIs) {
  const io::CloudInputOptions cloud =
      io::parse_cloud("/lidar/points beam=0.005 sensor=ouster_os1 merged sensor_frame=lidar");
  EXPECT_EQ(cloud.topic, "/lidar/points");
  EXPECT_EQ(cloud.rule.beam, 0.005) << "settings override the sensor's, in any order";
  EXPECT_EQ(cloud.rule.tolerance.a, CloudRule::for_sensor("ouster_os1").tolerance.a);
  EXPECT_FALSE(cloud.has_rays);
  EXPECT_EQ(cloud.sensor_frame, "lidar");
  EXPECT_TRUE(cloud.use_times);
  for (const char* const wrong :
       {"", "/points sensor=eyes", "/points tolerance=1,2", "/points beam=x", "/points beem=0.01",
        "/points removed_ranges=3", "/points sensor_frame="})
    EXPECT_THROW(static_cast<void>(io::parse_cloud(wrong)), InputError) << wrong;
}

}  // namespace
}  // namespace penumbra::test
