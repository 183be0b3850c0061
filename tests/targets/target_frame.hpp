// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/targets/target_judge.hpp>

namespace penumbra::test {

inline constexpr double share_rounding = 1e-12;
inline constexpr float hole = 0.0f;

/// A frame put together by hand: blocks of robot before a wall, labelled by the classifier.
struct TargetFrame {
  static constexpr int width = 160, height = 120;
  static constexpr float wall = 2.0f;  // metres

  explicit TargetFrame(const LabelRule& label_rule = without_cleanup())
      : rule(label_rule),
        robot(width, height),
        links(width, height),
        measured(width, height, wall),
        tiles(width, height),
        classifier(width, height, label_rule) {}

  [[nodiscard]] static LabelRule without_cleanup() {
    LabelRule rule;
    rule.front_min_width = 0;
    return rule;
  }

  [[nodiscard]] static Camera camera() {
    return {Intrinsics(width, height, 150, 155, 81, 58), {}, {}, {}};
  }

  /// Link number `link` of the robot at a depth, seen by the sensor where `seen`.
  void add_robot(int u0, int v0, int u1, int v1, float z, std::uint16_t link, bool seen = true) {
    for (const auto [u, v] : each_pixel(u0, v0, u1, v1)) {
      robot(u, v) = z;
      links(u, v) = std::uint16_t(link + 1);
      if (seen) measured(u, v) = z;
      tiles.mark(u, v, u, v);
    }
  }
  void see(int u0, int v0, int u1, int v1, float d) {
    for (const auto [u, v] : each_pixel(u0, v0, u1, v1)) measured(u, v) = d;
  }

  [[nodiscard]] LabelledImages images() {
    const VirtualDepthView view{robot.view(), links.view(), &tiles};
    return {classifier.classify(view, measured.view()), view, measured.view()};
  }

  LabelRule rule;
  Image<float> robot;
  Image<std::uint16_t> links;
  Image<float> measured;
  TileMask tiles;
  Classifier classifier;
};

/// On the wall, where blocks of robot are put before it.
inline const PixelBox middle_box{40, 40, 20, 20};

inline TargetView box_target(const PixelBox& box, Extent extent = Extent::amodal) {
  TargetView target;
  target.region = box;
  target.extent = extent;
  return target;
}

/// By a judge of its own.
inline Judgement judge_once(TargetFrame& frame, const TargetView& target) {
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  return judge.judge(target);
}

}  // namespace penumbra::test
