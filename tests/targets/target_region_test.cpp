// SPDX-License-Identifier: Apache-2.0
// What regions cover: shared edges and sizes. Which pixels those are is asked of geometry in
// target_oracle_test.cpp.
#include "target_frame.hpp"
#include "target_regions.hpp"

namespace penumbra::test {
namespace {

class Regions : public testing::Test {
 protected:
  Judgement judge(const Region& region) {
    TargetView target;
    target.region = region;
    judge_.begin(frame_.images());
    return judge_.judge(target);
  }

  static constexpr std::size_t all = std::size_t{TargetFrame::width} * TargetFrame::height;
  TargetFrame frame_;
  TargetJudge judge_{TargetFrame::camera(), frame_.rule, 3};
};

TEST_F(Regions, PolygonsOnTheGridThatShareEdgesShareNoPixel) {
  auto random = seeded_random(41);
  const auto grid = [&](double low, double high) {
    return std::round(std::uniform_real_distribution<double>(low, high)(random));
  };
  for (int i = 0; i < 100; ++i) {
    // A frame of four corners cut into triangles at a point of it: each pixel is in one of them.
    const Corners frame = {{grid(-9, 5), grid(-9, 5)},
                           {grid(50, 170), grid(-9, 5)},
                           {grid(50, 170), grid(40, 130)},
                           {grid(-9, 5), grid(40, 130)}};
    const Vector2d middle(grid(10, 45), grid(10, 35));
    const Judgement whole = judge(PixelPolygon{frame});
    std::size_t inside = 0, covered = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Corners part = {frame[k], frame[(k + 1) % 4], middle};
      const Judgement judged = judge(PixelPolygon{part});
      inside += judged.inside;
      covered += judged.covered;
    }
    EXPECT_EQ(inside, whole.inside);
    EXPECT_EQ(covered, whole.covered);
  }
}

TEST_F(Regions, LargeOnesCountByTheirArea) {
  // Of 256 rows above and 256 below the image the midpoint rule misses less than a row's share of
  // the triangle's height.
  constexpr double sampled = 1.0 / 256;
  constexpr double tolerance = 1e-9;  // rounding to whole pixels
  const double disc = std::numbers::pi * 2e10;
  const Corners triangle = {{-1e6, -1e6}, {1e6, -1e6}, {0, 2e6}};
  const Corners bow = {{-1e6, -1e6}, {1e6, 1e6}, {1e6, -1e6}, {-1e6, 1e6}};  // nothing cancels
  struct Case {
    Region region;
    double covered;
    std::size_t inside;
    double tolerance;
  };
  for (const Case& each : std::initializer_list<Case>{
           {PixelBox{-1e9, -1e9, 1e9, 1e9}, 1e18, 0, tolerance},
           {PixelEllipse{{20, 30}, {1e5, 2e5}, 0.4}, disc, all, tolerance},
           {PixelEllipse{{20, 1e6}, {1e5, 2e5}, 0}, disc, 0, tolerance},
           {PixelPolygon{triangle}, 3e12, all, sampled},
           {PixelPolygon{bow}, 2e12, judge(PixelPolygon{bow}).inside, sampled}}) {
    const Judgement judged = judge(each.region);
    EXPECT_NEAR(double(judged.covered) / each.covered, 1, each.tolerance);
    EXPECT_EQ(judged.inside, each.inside);
  }
}

TEST_F(Regions, CoverOnePixelAtLeast) {
  const Corners small = {{10.2, 10.2}, {10.4, 10.2}, {10.3, 10.4}};
  const Region regions[] = {PixelBox{10.2, 10.2, 0.3, 0.3}, PixelPolygon{small},
                            PixelEllipse{{10.3, 10.3}, {0.1, 0.1}, 0}};
  for (const Region& one : regions) {
    EXPECT_EQ(judge(one).covered, 1u);
    EXPECT_EQ(judge(one).inside, 1u);
  }
  const Judgement outside = judge(PixelEllipse{{-0.6, 3}, {0.1, 0.1}, 0});
  EXPECT_EQ(outside.covered, 1u);
  EXPECT_EQ(outside.inside, 0u);
}

}  // namespace
}  // namespace penumbra::test
