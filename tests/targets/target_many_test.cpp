// SPDX-License-Identifier: Apache-2.0
// No target costs memory once it was seen.
#include "../support/allocations.hpp"
#include "target_frame.hpp"
#include "target_regions.hpp"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using test::TargetFrame;

TEST(ManyTargets, AllocateNothingOnceSeen) {
  TargetFrame frame;
  frame.add_robot(60, 30, 110, 90, 1.0f, 1);
  Image<std::uint8_t> mask(TargetFrame::width, TargetFrame::height);
  Image<float> depth(TargetFrame::width, TargetFrame::height);
  for (int v = 20; v < 60; ++v)
    for (int u = 50; u < 80; ++u) mask(u, v) = 1, depth(u, v) = 1.5f;
  const std::vector<std::uint32_t> counts = test::run_lengths(mask.view());
  const test::Corners corners = {{10, 10}, {90, 20}, {70, 80}, {20, 70}};
  const Region regions[] = {PixelBox{40, 40, 50, 30},
                            PixelPolygon{corners},
                            PixelMask{mask.view()},
                            RunLengthMask{TargetFrame::width, TargetFrame::height, counts},
                            PixelEllipse{{60, 60}, {20, 10}, 0.5},
                            RenderedRegion{depth.view(), nullptr}};
  const char* const names[] = {"box",     "polygon", "mask", "a run-length mask with a long name",
                               "ellipse", "rendered"};
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  const LabelledImages images = frame.images();
  std::size_t points = 0;
  for (int i = 0; i < 20; ++i) {
    const std::size_t before = test::allocations();
    judge.begin(images);
    for (std::size_t k = 0; k < std::size(regions); ++k) {
      TargetView target;
      target.name = names[k];
      target.region = regions[k];
      target.extent = k < 5 && i > 0 ? Extent::modal : Extent::amodal;
      target.thresholds.hidden_enter = 1;
      if (k == 0) target.expected_depth = 2.0;
      points += judge.judge(target).point ? 1 : 0;
    }
    const std::size_t after = test::allocations();
    if (i < 2) continue;  // the first of each extent may
    ASSERT_EQ(after, before) << "frame " << i;
  }
  EXPECT_GT(points, 0u);
}

}  // namespace
}  // namespace penumbra
