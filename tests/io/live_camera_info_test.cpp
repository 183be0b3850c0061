// SPDX-License-Identifier: Apache-2.0
// By which camera_info an image is judged, or that it is not.
#include "live_inbox_bench.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using LiveCameraInfo = LiveInboxTest;

TEST_F(LiveCameraInfo, AnImageWaitsForItsOwnCameraInfo) {
  bench_.tell_all();
  bench_.tell_info(start);
  EXPECT_EQ(judge(start), 1U);  // camera_infos come with images
  tell_joints_around(start + 33 * milliseconds);
  bench_.tell_depth(start + 33 * milliseconds);
  EXPECT_EQ(bench_.work(), 0U);
  ASSERT_TRUE(bench_.inbox.wake_at(0));
  bench_.tell_info(start + 33 * milliseconds, 90.0);
  EXPECT_EQ(bench_.work(), 0U) << "it was told by the old camera_info";
  tell_joints_around(start + 66 * milliseconds);
  bench_.tell_depth(start + 66 * milliseconds);
  EXPECT_EQ(bench_.work(), 0U);
  bench_.results.published.clear();
  bench_.now = *bench_.inbox.wake_at(0);
  EXPECT_EQ(bench_.work(), 0U) << "it waits no longer than that, and is not judged by an older one";
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::no_camera_info), 1U);
  bench_.tell_info(start + 99 * milliseconds, 90.0);
  EXPECT_EQ(judge(start + 99 * milliseconds), 1U);
  EXPECT_EQ(status(), "ok");
  LiveTruth other({.focal = 90.0});
  EXPECT_EQ(expect_true_labels(bench_.results.published, other), 1U);
}

/// A camera that sends a camera_info with each image starts again as another one, whose camera_info
/// is heard a second later than its images.
TEST_F(LiveCameraInfo, NoImageIsJudgedByTheCameraInfoOfTheDriverBefore) {
  bench_.tell_all();
  const auto drive = [&](std::int64_t from, int images, double focal, std::uint64_t publisher) {
    std::size_t judged = 0;
    for (int i = 0; i < images; ++i) {
      const std::int64_t stamp = from + i * 33 * milliseconds;
      if (focal > 0)
        bench_.tell("/camera/depth/camera_info", encoded(live_info(stamp, {.focal = focal})),
                    publisher);
      tell_joints_around(stamp);
      bench_.tell("/camera/depth/image_rect_raw", live_depth(stamp), publisher);
      bench_.now += 33 * milliseconds;
      judged += bench_.work();
    }
    return judged;
  };
  EXPECT_EQ(drive(start, 5, 60.0, 1), 5U);
  bench_.results.published.clear();
  EXPECT_EQ(drive(start + seconds, 30, 0.0, 2), 0U);
  bench_.now += 200 * milliseconds;
  EXPECT_EQ(bench_.work(), 0U);
  EXPECT_EQ(bench_.counts().of(io::LiveDrop::no_camera_info), 30U);
  EXPECT_EQ(bench_.inbox.camera(0).without_info(), 30U);
  EXPECT_EQ(drive(start + 2 * seconds, 3, 90.0, 2), 3U);
  EXPECT_EQ(bench_.inbox.camera(0).without_info(), 0U);
  LiveTruth other({.focal = 90.0});
  EXPECT_EQ(expect_true_labels(bench_.results.published, other), 3U);
  // Again, now by a clock that begins anew: what came before is later than all that comes.
  bench_.results.published.clear();
  EXPECT_EQ(drive(start - 900 * seconds, 10, 0.0, 3), 0U);
  EXPECT_EQ(drive(start - 899 * seconds, 3, 60.0, 3), 3U);
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 3U);
}

/// The clock is set back by less than camera_infos are kept for: those that came before are not of
/// the images that come now.
TEST_F(LiveCameraInfo, CameraInfosFromBeforeAJumpOfTheClockAreOfNoImageAfterIt) {
  bench_.tell_all();
  const auto drive = [&](std::int64_t from, int images, bool with_info) {
    std::size_t judged = 0;
    for (int i = 0; i < images; ++i) {
      const std::int64_t stamp = from + i * 33 * milliseconds;
      if (with_info) bench_.tell_info(stamp);
      tell_joints_around(stamp);
      bench_.tell_depth(stamp);
      bench_.now += 33 * milliseconds;
      judged += bench_.work();
    }
    return judged;
  };
  EXPECT_EQ(drive(start, 90, true), 90U);
  EXPECT_EQ(drive(start + 1500 * milliseconds, 20, false), 0U) << "the clock went back by 1.5 s";
  EXPECT_EQ(drive(start + 1500 * milliseconds + seconds, 3, true), 3U);
}

TEST_F(LiveCameraInfo, CameraInfosThatComeOnceOrSeldomHoldForAllImages) {
  bench_.tell_all();
  std::size_t judged = 0;
  for (int i = 0; i < 60; ++i) {
    const std::int64_t stamp = start + i * 33 * milliseconds;
    if (i % 30 == 10) bench_.tell_info(stamp);  // of an image's stamp, once a second
    tell_joints_around(stamp);
    bench_.tell_depth(stamp);
    bench_.now += 33 * milliseconds;
    judged += bench_.work();
  }
  bench_.now += 200 * milliseconds;
  judged += bench_.work();
  const io::LiveCounts counts = bench_.counts();
  EXPECT_EQ(counts.of(io::LiveDrop::no_camera_info), 0U);
  EXPECT_EQ(judged + counts.of(io::LiveDrop::superseded), 60U);
  EXPECT_GT(judged, 50U);
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), judged);
}

}  // namespace
}  // namespace penumbra::test
