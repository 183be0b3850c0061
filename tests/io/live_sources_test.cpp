// SPDX-License-Identifier: Apache-2.0
// Depth in all forms that live takes, and poses from all that tell them.
#include "live_scene.hpp"
#include "ros_images.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

const LiveLens small_lens;

io::LiveOptions options_with(const std::string& depth_topic, PoseSource poses) {
  io::LiveOptions options = LiveBench::one_camera();
  options.poses = options.cameras[0].poses = poses;
  options.cameras[0].depth_topic = depth_topic;
  return options;
}

void tell_joints_around(LiveBench& bench, std::int64_t stamp) {
  bench.tell_joints(stamp - 10 * milliseconds);
  bench.tell_joints(stamp + 10 * milliseconds);
}

std::string status_of(LiveBench& bench) {
  return bench.results.last<io::TargetsMessage>(io::Result::targets).status;
}

void expect_nothing_trusted(LiveBench& bench) {
  const auto mask = bench.results.last<io::ImageMessage>(io::Result::mask);
  for (const std::byte pixel : mask.data) ASSERT_EQ(pixel, std::byte{255});
}

/// Where the robot is known, but no depth: it is unknown there, and the rest is free of it.
void expect_no_depth(LiveBench& bench, std::int64_t stamp) {
  LiveTruth truth;
  const auto labels = bench.results.last<io::ImageMessage>(io::Result::labels);
  const FrameReport& report = truth.judge(stamp);
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    const bool on_robot = static_cast<Label>(report.labels.data[i]) != Label::clear;
    ASSERT_EQ(static_cast<Label>(labels.data[i]), on_robot ? Label::unknown : Label::clear) << i;
  }
}

class LiveCompressedDepth : public testing::TestWithParam<bool> {};

TEST_P(LiveCompressedDepth, IsJudgedAsWhatItHolds) {
  const std::string topic = "/camera/depth/image_rect_raw/compressedDepth";
  LiveBench bench(options_with(topic, PoseSource::joints));
  bench.tell_all();
  const Image<std::uint16_t> wall(small_lens.width, small_lens.height, 3000);
  const auto data = compressed_depth(wall, GetParam(), 0, 0);
  const std::string format = std::string("16UC1; compressedDepth") + (GetParam() ? " rvl" : " png");
  tell_joints_around(bench, start);
  bench.tell(topic, encoded(io::CompressedImageMessage{{start, "optical"}, format, data}));
  ASSERT_EQ(bench.work(), 1U);
  EXPECT_EQ(status_of(bench), "ok");
  LiveTruth truth;
  EXPECT_EQ(expect_true_labels(bench.results.published, truth), 1U);

  const std::int64_t next = start + 33 * milliseconds;
  tell_joints_around(bench, next);
  bench.tell(topic, encoded(io::CompressedImageMessage{
                        {next, "optical"}, format, std::span(data).first(data.size() / 2)}));
  bench.work();
  EXPECT_EQ(status_of(bench), "bad_depth");
  expect_no_depth(bench, next);
}

INSTANTIATE_TEST_SUITE_P(Forms, LiveCompressedDepth, testing::Bool(),
                         [](const auto& form) { return form.param ? "Rvl" : "Png"; });

/// A depth camera 5 cm beside the color camera, which sees more.
class LiveUnalignedDepth : public testing::Test {
 protected:
  static constexpr double beside = 0.05;           // m, to the right
  static constexpr double wall = 3.0, near = 0.5;  // m
  static constexpr LiveLens wide{.focal = 40.0};

  static io::LiveOptions options() {
    io::LiveOptions options = LiveBench::one_camera();
    options.cameras[0].color_topic = "/camera/color/image_raw";
    options.cameras[0].color_info_topic = "/camera/color/camera_info";
    return options;
  }
  LiveUnalignedDepth() {
    bench_.tell_robot();
    bench_.tell_mount();
    io::CameraInfoMessage info = live_info(0, wide);
    info.header.frame_id = "depth_optical";
    bench_.tell("/camera/depth/camera_info", encoded(info));
    bench_.tell("/camera/color/camera_info", encoded(live_info(0)));
  }
  void tell_registration() {
    bench_.tell("/tf_static",
                encoded(io::TfMessage{{{{0, "optical"},
                                        "depth_optical",
                                        Eigen::Isometry3d(Eigen::Translation3d(beside, 0, 0))}}}));
  }
  /// The wall, and something near from a column on.
  void judge(std::int64_t stamp, int near_from) {
    Image<std::uint16_t> depth(wide.width, wide.height, static_cast<std::uint16_t>(1000 * wall));
    for (int v = 0; v < wide.height; ++v)
      for (int u = near_from; u < wide.width; ++u)
        depth(u, v) = static_cast<std::uint16_t>(1000 * near);
    tell_joints_around(bench_, stamp);
    bench_.tell("/camera/depth/image_rect_raw",
                encoded(io::image_message(io::MessageHeader{stamp, "depth_optical"}, "16UC1",
                                          std::as_const(depth).view())));
    bench_.now += 33 * milliseconds;
    bench_.work();
  }
  /// Where an edge of a depth image's columns lies in the color image.
  static double column_of(double edge, double depth) {
    const double x = (edge - wide.cx) / wide.focal * depth + beside;
    return small_lens.focal * x / depth + small_lens.cx;
  }

  LiveBench bench_{options()};
};

TEST_F(LiveUnalignedDepth, IsBroughtToTheColorCameraByTf) {
  tell_registration();
  judge(start, wide.width);
  EXPECT_EQ(status_of(bench_), "ok");
  LiveTruth truth;
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth), 1U);

  constexpr int near_from = 32;
  judge(start + 2 * seconds, near_from);  // the board lies level again
  const auto labels = bench_.results.last<io::ImageMessage>(io::Result::labels);
  ASSERT_EQ(labels.width, static_cast<std::uint32_t>(small_lens.width));
  const auto label_at = [&](double column) {
    const auto row = static_cast<std::size_t>(small_lens.height / 2);
    const auto u = static_cast<std::size_t>(std::lround(column));
    return static_cast<Label>(labels.data[row * labels.width + u]);
  };
  const double last_of_wall = column_of(near_from - 0.5, wall);
  const double first_near = column_of(near_from - 0.5, near);
  ASSERT_GT(first_near - last_of_wall, 4.0) << "the cameras see differently";
  EXPECT_EQ(label_at(last_of_wall - 2), Label::beyond);
  EXPECT_EQ(label_at(0.5 * (last_of_wall + first_near)), Label::unknown) << "nothing sees that";
  EXPECT_EQ(label_at(first_near + 2), Label::front);
}

TEST_F(LiveUnalignedDepth, WithoutTheWayToTheColorCameraAllIsUnknown) {
  judge(start, wide.width);
  EXPECT_EQ(status_of(bench_), "bad_depth");
  expect_no_depth(bench_, start);
  tell_registration();
  judge(start + 100 * milliseconds, wide.width);
  EXPECT_EQ(status_of(bench_), "ok");
}

class LivePoses : public testing::Test {
 protected:
  static std::vector<std::byte> board(std::int64_t stamp, double turned_more) {
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(0, 0, 1) *
        Eigen::AngleAxisd(spin_at(stamp) + turned_more, Eigen::Vector3d::UnitZ());
    return encoded(io::TfMessage{{{{stamp, "base"}, "board", pose}}});
  }
  static void tell_tf_around(LiveBench& bench, std::int64_t stamp, double turned_more = 0.0) {
    bench.tell("/tf", board(stamp - 20 * milliseconds, turned_more));
    bench.tell("/tf", board(stamp + 20 * milliseconds, turned_more));
  }
  static std::string judge(LiveBench& bench, std::int64_t stamp) {
    bench.tell_depth(stamp);
    bench.now += 200 * milliseconds;
    EXPECT_EQ(bench.work(), 1U);
    return status_of(bench);
  }
  static constexpr const char* topic = "/camera/depth/image_rect_raw";
  LiveTruth truth_;
};

TEST_F(LivePoses, ComeFromTfInPlaceOfJointStates) {
  LiveBench bench(options_with(topic, PoseSource::transforms));
  bench.tell_all();
  for (int i = 0; i < 30; ++i) {
    const std::int64_t stamp = start + i * 67 * milliseconds;
    tell_tf_around(bench, stamp);
    EXPECT_EQ(judge(bench, stamp), "ok") << i;
  }
  EXPECT_EQ(expect_true_labels(bench.results.published, truth_), 30U);
  for (const io::LiveTopic& one : bench.inbox.topics()) EXPECT_NE(one.role, io::LiveRole::joints);

  EXPECT_NE(judge(bench, start + 10 * seconds), "ok") << "what was told last is no pose of now";
  expect_nothing_trusted(bench);
}

TEST_F(LivePoses, OfBothAreTakenWhereTheyAgree) {
  LiveBench bench(options_with(topic, PoseSource::both));
  bench.tell_all();
  constexpr double off = 0.05;  // radians, 25 mm at the lever of 0.5 m
  for (int i = 0; i < 12; ++i) {
    const std::int64_t stamp = start + i * 333 * milliseconds;
    const bool agree = i % 3 != 1;
    tell_joints_around(bench, stamp);
    tell_tf_around(bench, stamp, agree ? 0.0 : off);
    EXPECT_EQ(judge(bench, stamp), agree ? "ok" : "poses_disagree") << i;
    if (!agree) expect_nothing_trusted(bench);
  }
  EXPECT_EQ(expect_true_labels(bench.results.published, truth_), 8U);
  const std::int64_t later = start + 10 * seconds;
  tell_joints_around(bench, later);
  EXPECT_NE(judge(bench, later), "ok") << "one of both alone is not enough";
}

/// Of two cameras that share a robot, one's clock is set back alone.
TEST(LiveClocks, ACameraThatIsSetBackHoldsTheOthersUpForAMomentAlone) {
  io::LiveOptions options;
  for (const std::string name : {"left", "right"})
    options.cameras.push_back({.name = name,
                               .depth_topic = "/" + name + "/depth",
                               .info_topic = "/" + name + "/camera_info"});
  LiveBench bench(options);
  bench.tell_robot();
  bench.tell_mount();
  for (const char* const info : {"/left/camera_info", "/right/camera_info"})
    bench.tell(info, encoded(live_info(0)));
  constexpr int images = 30;
  constexpr int set_back_at = 10;
  for (int i = 0; i < images; ++i) {
    const std::int64_t stamp = start + i * 33 * milliseconds;
    bench.tell_joints(stamp - 10 * milliseconds);
    bench.tell("/left/depth", live_depth(stamp));
    bench.tell("/right/depth", live_depth(i < set_back_at ? stamp : stamp - 5 * seconds));
    bench.tell_joints(stamp + 10 * milliseconds);
    bench.now += 33 * milliseconds;
    bench.work();
  }
  EXPECT_EQ(bench.inbox.robot().posed()->history.clock_jumps(), 1U);
  EXPECT_EQ(bench.counts().of(io::LiveDrop::clock_jump), 1U) << "the one that waited";
  bench.now += 200 * milliseconds;
  bench.work();
  LiveTruth truth;
  EXPECT_EQ(expect_true_labels(bench.results.published, truth), images - 1U);
}

}  // namespace
}  // namespace penumbra::test
