// SPDX-License-Identifier: Apache-2.0
// Live clouds: a lidar that sees the turning board before a wall, each point when it was measured.
#include "../support/errors.hpp"
#include "live_run.hpp"

#include <io/live/cloud_text.hpp>
#include <io/live/live_diagnostics.hpp>

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
std::size_t wrong_labels(const KeptResults::Published& one) {
  const auto cloud = decoded<io::PointCloud2Message>(one.payload);
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

/// Counts the scans that a page would show.
class ScanWatcher final : public io::FrameWatcher {
 public:
  [[nodiscard]] bool wants_color() const override { return false; }
  void take(const io::AssembledFrame& job, const FrameReport& report, const Drift&) override {
    EXPECT_EQ(static_cast<std::size_t>(report.labels.width), job.scan->points.count);
    EXPECT_TRUE(report.status != FrameStatus::ok || report.T_root_link.size() == 2);
    ++scans;
  }
  std::size_t scans = 0;
};

class LiveClouds : public testing::Test {
 protected:
  void start(const std::string& text = "/points") {
    kept_.wanted = {io::Result::without_robot, io::Result::labelled, io::Result::targets};
    options_.clouds = {io::parse_cloud(text)};
    options_.clouds[0].has_targets = !options_.target_topics.empty();
    run_ =
        std::make_unique<LiveRun>(options_, PipelineConfig{}, std::vector<io::ResultSink*>{&kept_},
                                  io::make_robot, std::chrono::seconds(5));
    run_->watch(0, watcher_);
    run_->start();
    run_->say_robot_and_mount();
    ASSERT_TRUE(run_->wait_for_robot());
  }
  /// Says joint states, every 10 ms of them, and a scan each 100 ms.
  void scan(int scans, std::int64_t begin = test::start) {
    for (int i = 0; i < scans; ++i) {
      const std::int64_t stamp = begin + i * scan_time;
      for (std::int64_t t = 0; t <= scan_time; t += 10 * milliseconds)
        run_->say("/joint_states", live_joints(stamp + t));
      say_scan(LidarScan(stamp));
    }
  }
  /// Waits until it is labelled or dropped.
  void say_scan(const LidarScan& scan) {
    const std::size_t before = done();
    run_->say("/points", encoded(scan.message));
    ASSERT_TRUE(wait_until([&] { return done() > before; }));
  }
  /// The board hides it at any angle.
  void say_knob(std::int64_t stamp) { run_->say("/knob", live_target(stamp, {0, 0, 1.2})); }
  std::size_t done() {
    return run_->with_inbox(
        [](const io::LiveInbox& inbox) { return LiveRun::done(inbox.cloud(0)); });
  }
  bool wait_for_targets() {
    return wait_until([&] { return !kept_.kept(io::Result::targets).empty(); });
  }
  /// When the last cloud arrived.
  io::LiveFault fault() {
    const std::vector<io::LiveLink> links(run_->topics.size(), {.is_open = true});
    return run_->with_inbox([&](const io::LiveInbox& inbox) {
      return io::cloud_fault(inbox, 0, links, *inbox.cloud(0).arrivals().last());
    });
  }

  io::LiveOptions options_;
  SharedResults kept_;
  ScanWatcher watcher_;
  std::unique_ptr<LiveRun> run_;
};

TEST_F(LiveClouds, FollowTheRobotThroughEachScan) {
  start();
  scan(5);
  run_->stop();
  EXPECT_FALSE(run_->fault());
  const auto labelled = kept_.kept(io::Result::labelled),
             clean = kept_.kept(io::Result::without_robot);
  ASSERT_EQ(labelled.size(), 5U);
  ASSERT_EQ(clean.size(), 5U);
  for (std::size_t i = 0; i < labelled.size(); ++i) {
    EXPECT_EQ(wrong_labels(labelled[i]), 0U) << "scan " << i;
    const auto cloud = decoded<io::PointCloud2Message>(clean[i].payload);
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
  run_->stop();
  ASSERT_EQ(kept_.kept(io::Result::labelled).size(), 2U);
  EXPECT_GT(wrong_labels(kept_.kept(io::Result::labelled)[1]), 50U);
}

TEST_F(LiveClouds, JudgeTheTargetsOfTheirStampThatComeLater) {
  options_.target_topics = {"/knob"};
  start();
  scan(3);
  say_knob(test::start + scan_time);  // the second of three scans
  scan(1, test::start + 3 * scan_time);
  ASSERT_TRUE(wait_for_targets());
  run_->stop();
  const auto kept = kept_.kept(io::Result::targets);
  ASSERT_EQ(kept.size(), 1U);
  const auto targets = decoded<io::TargetsMessage>(kept[0].payload);
  EXPECT_EQ(targets.header.stamp, test::start + 3 * scan_time);
  ASSERT_EQ(targets.targets.size(), 1U);
  EXPECT_EQ(targets.targets[0].name, "/knob");
  EXPECT_EQ(targets.targets[0].stamp, test::start + scan_time);
  EXPECT_EQ(targets.targets[0].verdict, io::TargetMessage::hidden) << targets.targets[0].reason;
  ASSERT_FALSE(targets.targets[0].blame.empty());
  EXPECT_EQ(targets.targets[0].blame[0].link, "board");
  EXPECT_EQ(kept_.kept(io::Result::labelled).size(), 4U) << "each cloud comes once";
  EXPECT_EQ(watcher_.scans, 4U);
}

TEST_F(LiveClouds, GoOnWithTargetsAfterTheClockJumpedBack) {
  options_.target_topics = {"/knob"};
  start();
  scan(2, test::start + 100 * seconds);
  scan(1);  // 100 s earlier
  say_knob(test::start + scan_time);
  scan(1, test::start + scan_time);
  EXPECT_TRUE(wait_for_targets());
}

TEST_F(LiveClouds, WithoutJointStatesAreUnknownAndSaySo) {
  start();
  say_scan(LidarScan(test::start));
  const auto clean = kept_.kept(io::Result::without_robot);
  EXPECT_EQ(decoded<io::PointCloud2Message>(clean.at(0).payload).width, 0U);
  EXPECT_TRUE(holds(fault().why, "missing_joints"));
}

TEST_F(LiveClouds, InAFrameAboveTheRobotAreRefused) {
  start();
  run_->say("/tf_static", live_transform("odom", "base"));
  LidarScan scan(test::start);
  scan.message.header.frame_id = "odom";
  say_scan(scan);
  EXPECT_TRUE(holds(fault().why, "above the robot"));
  EXPECT_TRUE(kept_.kept(io::Result::without_robot).empty());
}

TEST_F(LiveClouds, ThatCannotBeReadAreCountedWithTheReason) {
  start();
  LidarScan scan(test::start);
  scan.message.fields[2].name = "w";
  say_scan(scan);
  const auto [dropped, why] = run_->with_inbox([](const io::LiveInbox& inbox) {
    const auto& faults = inbox.faults().all();
    return std::pair(inbox.cloud(0).counts().of(DropReason::unreadable),
                     faults.empty() ? std::string() : faults.begin()->second.what);
  });
  EXPECT_EQ(dropped, 1U);
  EXPECT_TRUE(holds(why, "z"));
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
