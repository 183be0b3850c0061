// SPDX-License-Identifier: Apache-2.0
// Many targets, and that none of them costs memory once it was seen.
#include "../support/allocations.hpp"
#include "target_frame.hpp"
#include "target_regions.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using test::TargetFrame;

constexpr double most_seconds = 2;  // for 10 000 small targets; a hundredth of it is usual

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

TEST(ManyTargets, TenThousandAFrame) {
  TargetFrame frame;
  frame.add_robot(60, 30, 110, 90, 1.0f, 1);
  std::vector<std::string> names;
  names.reserve(10000);
  for (int i = 0; i < 10000; ++i) names.push_back("target " + std::to_string(i));
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  std::size_t hidden = 0, visible = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int round = 0; round < 3; ++round) {
    judge.begin(frame.images());
    for (std::size_t i = 0; i < names.size(); ++i) {
      TargetView target;
      target.name = names[i];
      const std::size_t row = i / 100, column = i % 160;
      target.region =
          PixelEllipse{{static_cast<double>(column), static_cast<double>(row)}, {5, 5}, 0};
      const Judgement judgement = judge.judge(target);
      hidden += judgement.verdict == Verdict::hidden ? 1 : 0;
      visible += judgement.verdict == Verdict::visible ? 1 : 0;
    }
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  RecordProperty("microseconds_per_target", std::to_string(took.count() * 1e6 / 30000));
  std::cout << took.count() * 1e6 / 30000 << " us per target\n";
  EXPECT_LT(took.count(), 3 * most_seconds);
  EXPECT_GT(hidden, 1000u);
  EXPECT_GT(visible, 10000u);
}

}  // namespace
}  // namespace penumbra
