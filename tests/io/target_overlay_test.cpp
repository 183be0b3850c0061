// SPDX-License-Identifier: Apache-2.0
// Targets drawn into frames: what is said of them, and where late ones are.
#include "files.hpp"
#include "robots.hpp"

#include <gtest/gtest.h>

#include <io/files/target_overlay.hpp>

namespace penumbra::io {
namespace {

constexpr Rgb8 grey{100, 100, 100};
constexpr std::int64_t second = 1'000'000'000;

class TargetOverlayTest : public testing::Test {
 protected:
  /// A frame with one target, seen from a camera at x in the root's frame that looks along z.
  Image<Rgb8> draw(const TargetReport& said, std::int64_t stamp, double camera_x,
                   const TargetShape& shape) {
    const Target target{.name = std::string(said.name), .shape = shape};
    FrameReport report;
    report.stamp = stamp;
    report.T_root_camera = Eigen::Translation3d(camera_x, 0, 0) * Eigen::Isometry3d::Identity();
    report.T_root_link = {&T_root_, 1};
    report.targets = {&said, 1};
    Image<Rgb8> out(320, 240, grey);
    overlay_.draw({&target, 1}, report, robot_, camera_, out);
    return out;
  }
  static bool is_drawn(const Image<Rgb8>& image, int u, int v) { return !(image(u, v) == grey); }

  const Robot robot_ = test::bare_robot();
  const Camera camera_{Intrinsics(320, 240, 200, 200, 160, 120), {}, {}, "camera"};
  const Eigen::Isometry3d T_root_ = Eigen::Isometry3d::Identity();
  TargetOverlay overlay_;
};

TargetReport said(Verdict verdict, std::int64_t stamp, double occluded) {
  TargetReport report;
  report.name = "lid";
  report.stamp = stamp;
  report.verdict = verdict;
  report.judgement.emplace();
  report.judgement->inside = 100;
  report.judgement->occluded = occluded;
  return report;
}

/// "unknown 0%" would read as "0 % hidden".
TEST_F(TargetOverlayTest, UnknownHasNoShare) {
  const RegionTarget box{PixelBox{100, 100, 40, 40}};
  const auto drawn = [&](Verdict verdict, double share) {
    return draw(said(verdict, 0, share), 0, 0.0, box);
  };
  EXPECT_TRUE(test::same_pixels(drawn(Verdict::unknown, 0.0).view(),
                                drawn(Verdict::unknown, 0.001).view()));
  EXPECT_FALSE(
      test::same_pixels(drawn(Verdict::unknown, 0.0).view(), drawn(Verdict::unknown, 0.5).view()))
      << "at least 50 %";
  EXPECT_FALSE(
      test::same_pixels(drawn(Verdict::partial, 0.3).view(), drawn(Verdict::partial, 0.5).view()));
}

/// The camera moves half a metre meanwhile: what stands still is seen 100 pixels further left.
TEST_F(TargetOverlayTest, ALateTargetIsDrawnWhereItIsSeenNow) {
  const PointTarget ball{.position = {0.25, 0, 1}, .radius = 0.05};  // at u 210, 10 pixels wide
  const Image<Rgb8> first = draw(said(Verdict::visible, 0, 0), 0, 0.0, ball);
  EXPECT_TRUE(is_drawn(first, 200, 120));
  const Image<Rgb8> late = draw(said(Verdict::visible, 0, 0), second, 0.5, ball);
  EXPECT_TRUE(is_drawn(late, 100, 120));
  EXPECT_FALSE(is_drawn(late, 200, 120)) << "as if the camera stood where it was";
  const Image<Rgb8> own = draw(said(Verdict::visible, 2 * second, 0), 2 * second, 0.5, ball);
  EXPECT_TRUE(is_drawn(own, 200, 120)) << "of its own frame it is drawn in that camera";
}

TEST_F(TargetOverlayTest, ATargetOfAFrameThatWasNotSeenIsNotDrawn) {
  const PointTarget ball{.position = {0.25, 0, 1}, .radius = 0.05};
  const Image<Rgb8> image = draw(said(Verdict::visible, -second, 0), 0, 0.0, ball);
  EXPECT_TRUE(test::same_pixels(image.view(), Image<Rgb8>(320, 240, grey).view()));
}

}  // namespace
}  // namespace penumbra::io
