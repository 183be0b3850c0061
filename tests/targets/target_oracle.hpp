// SPDX-License-Identifier: Apache-2.0
// A judge that asks every pixel of the image, in words of TargetJudge's docstring.
#pragma once

#include "../labels/scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <penumbra/targets/target_judge.hpp>

namespace penumbra::test {

struct NaiveJudgement {
  std::size_t inside = 0;
  std::size_t clear = 0, front = 0, occluded = 0, unknown = 0, other = 0;
  std::size_t measured = 0, past = 0;        // of the clear and front ones
  std::map<std::size_t, std::size_t> blame;  // pixels by link
  std::vector<float> trusted;                // sorted

  [[nodiscard]] double median() const { return static_cast<double>(trusted[trusted.size() / 2]); }
  [[nodiscard]] double spread() const {
    NaiveJudgement deviations;
    for (const float d : trusted)
      deviations.trusted.push_back(std::abs(d - static_cast<float>(median())));
    std::sort(deviations.trusted.begin(), deviations.trusted.end());
    return 1.4826 * deviations.median();
  }
};

/// A frame and a target of it as the naive judge takes them: images in metres, measurements out of
/// range 0, expected depth per pixel (0: none).
struct NaiveTarget {
  const LabelRule& rule;
  ImageView<const std::uint8_t> labels;
  ImageView<const float> robot;
  ImageView<const std::uint16_t> links;
  ImageView<const float> measured;
  ImageView<const std::uint8_t> mask;
  ImageView<const float> expected;
  float depth_margin = 0;
  bool beyond_hides = true;

  [[nodiscard]] float tolerance(float z) const {
    const auto a = static_cast<float>(rule.tolerance.a), b = static_cast<float>(rule.tolerance.b),
               c = static_cast<float>(rule.tolerance.c);
    return a + (b + c * z) * z;
  }

  void look(int u, int v, NaiveJudgement& result) const {
    auto label = static_cast<Label>(labels(u, v));
    if (label == Label::beyond) label = beyond_hides ? Label::occluded : Label::clear;
    const bool is_fringe = label == Label::fringe;  // it hides nothing and measures nothing
    if (is_fringe) label = Label::clear;
    const float z = robot(u, v), d = is_fringe ? 0 : measured(u, v), ze = expected(u, v);
    if (ze > 0) {
      const float m = tolerance(ze) + depth_margin;
      const bool on_robot = label != Label::clear;
      const bool robot_before = on_robot && z<ze - m, robot_behind = z> ze + m;
      if (robot_before) {
        label = Label::occluded;
      } else if (d > 0 && d < ze - m) {
        if (label != Label::occluded) {
          ++result.other;
          return;
        }
      } else if (on_robot && label != Label::front) {
        label = robot_behind ? Label::clear : Label::unknown;
      }
    }
    const bool is_seen = label == Label::clear || label == Label::front;
    if (is_seen && d > 0) ++result.measured;
    if (ze > 0 && is_seen && d > ze + (tolerance(ze) + depth_margin)) ++result.past;
    if (label == Label::clear) ++result.clear;
    if (label == Label::front) ++result.front;
    if (label == Label::unknown) ++result.unknown;
    if (label != Label::occluded) return;
    ++result.occluded;
    if (links(u, v) > 0) ++result.blame[links(u, v) - 1u];
  }

  [[nodiscard]] bool trusted(int u, int v) const {
    const auto label = static_cast<Label>(labels(u, v));
    const float d = measured(u, v), ze = expected(u, v);
    if ((label != Label::clear && label != Label::front) || !(d > 0)) return false;
    const float m = tolerance(ze) + depth_margin;
    if (ze > 0 && (d < ze - m || d > ze + m)) return false;
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
    const int cells = (std::max(rule.edge_margin, 8) + 3) / 4;
    for (int y = 0; y < robot.height; ++y) {
      for (int x = 0; x < robot.width; ++x) {
        if (std::abs(x / 4 - u / 4) > cells || std::abs(y / 4 - v / 4) > cells) continue;
        if (!(robot(x, y) > 0)) continue;
        nearest = std::min(nearest, robot(x, y));
        farthest = std::max(farthest, robot(x, y));
      }
    }
    if (farthest == 0) return true;
    const float past = static_cast<float>(rule.beyond_factor) * tolerance(farthest);
    return d < nearest - tolerance(nearest) || d > farthest + past;
  }

  [[nodiscard]] NaiveJudgement judge() const {
    NaiveJudgement result;
    for (int v = 0; v < mask.height; ++v) {
      for (int u = 0; u < mask.width; ++u) {
        if (mask(u, v) == 0) continue;
        ++result.inside;
        look(u, v, result);
        if (trusted(u, v)) result.trusted.push_back(measured(u, v));
      }
    }
    std::sort(result.trusted.begin(), result.trusted.end());
    return result;
  }
};

}  // namespace penumbra::test
