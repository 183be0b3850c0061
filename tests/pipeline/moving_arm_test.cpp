// SPDX-License-Identifier: Apache-2.0
// An arm in motion, images that arrive 30 ms after their stamps: only the states of the stamp give
// the right picture. Whoever takes the latest state is proven wrong on the same frames.
#include "slab_scene.hpp"

#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t start = 1'700'000'000'000 * ms;
constexpr std::int64_t image_delay = 30 * ms;
constexpr int frames = 40;

/// Up to 2 m/s: 60 mm in 30 ms, where labels tolerate 20 mm.
double slide_at(std::int64_t stamp) { return 0.4 * std::sin(5.0 * 1e-9 * double(stamp - start)); }

/// How many of the robot's pixels are not labelled as what they are: the robot itself.
double wrong_share(const FrameReport& report) {
  return double(report.pixels.front + report.pixels.beyond + report.pixels.unknown) /
         double(report.pixels.robot.value());
}

/// Images are 33 ms apart.
constexpr std::int64_t image_stamp(int i) { return start + 5 * ms + i * 33 * ms; }

class MovingArm : public testing::TestWithParam<PoseSource> {
 protected:
  void tell(std::int64_t stamp) {
    latest_ = slide_at(stamp);
    const std::string names[] = {"slide"};
    const double positions[] = {latest_};
    history_.add_joints(stamp, names, positions);
    history_.add_transform(stamp, "base", "slab", at(0, 0, 1 + latest_));
  }

  const FrameReport& process(Frame frame, std::int64_t stamp) {
    depth_ = scene_depth(camera_, slide_at(stamp));
    frame.depth = depth_.view();
    return pipeline_.process(frame);
  }

  void judge_queue(FrameQueue& queue, std::int64_t now) {
    while (const auto queued = queue.next(now)) {
      const FrameReport& report = process(*queued, *queued->stamp);
      ASSERT_EQ(report.status, FrameStatus::ok) << report.message;
      EXPECT_EQ(report.stamp, queued->stamp);
      EXPECT_EQ(wrong_share(report), 0.0) << "frame " << judged_;
      ++judged_;
    }
  }

  /// Joint states come every 10 ms or so.
  void run(std::int64_t joint_delay) {
    auto random = seeded_random(3);
    FrameQueue queue(robot_, history_,
                     {.policy = DropPolicy::every, .poses = {.source = GetParam()}});
    int image = 0;
    for (int i = -5; i < frames * 4; ++i) {
      const std::int64_t stamp = start + i * 10 * ms + std::int64_t(random() % ms);
      const std::int64_t arrival = stamp + joint_delay;
      for (; image < frames && image_stamp(image) + image_delay <= arrival; ++image) {
        const std::int64_t now = image_stamp(image) + image_delay;
        queue.push({.stamp = image_stamp(image)}, now);
        judge_queue(queue, now);
        judge_latest(image_stamp(image));
      }
      tell(stamp);
      judge_queue(queue, arrival);
    }
    EXPECT_EQ(judged_, frames);
  }

  void judge_latest(std::int64_t stamp) {
    Frame frame;
    frame.pose.positions = {latest_};
    const FrameReport& report = process(frame, stamp);
    if (wrong_share(report) > 0.05) ++wrong_by_latest_;
  }

  Robot robot_ = slab_robot();
  Camera camera_ = slab_camera();
  Pipeline pipeline_{slab_robot(), camera_, plain_config()};
  PoseHistory history_{robot_};
  Image<float> depth_;
  double latest_ = 0;
  int judged_ = 0, wrong_by_latest_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Sources, MovingArm,
                         testing::Values(PoseSource::joints, PoseSource::transforms,
                                         PoseSource::both),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST_P(MovingArm, IsSeenWhereItWasAndTheLatestStateWouldFail) {
  run(1 * ms);
  EXPECT_GT(wrong_by_latest_, frames / 2) << "or this scene proves nothing";
}

TEST_P(MovingArm, IsSeenWhereItWasThoughStatesComeAfterTheImages) { run(80 * ms); }

}  // namespace
}  // namespace penumbra::test
