// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slab_scene.hpp"

namespace penumbra::test {

/// The slab's near face spans u 48..98, v 45..69 at slide 0, u 37..110 at slide -0.3; the wall
/// stands at 3 m.
inline const PixelBox behind_slab{60, 50, 20, 12};
inline const PixelBox beside_slab{10, 80, 20, 12};

class TargetsTest : public testing::Test {
 protected:
  explicit TargetsTest(double history = 0.0)
      : pipeline_(slab_robot(), slab_camera(), [&] {
          PipelineConfig config = plain_config();
          config.target_history = history;
          return config;
        }()) {}

  const FrameReport& process(std::int64_t stamp, std::vector<Target> targets) {
    return pipeline_.process({.stamp = stamp,
                              .depth = depth_.view(),
                              .pose = {.positions = positions_},
                              .targets = std::move(targets)});
  }
  const TargetReport& judge(std::int64_t stamp, const Target& target) {
    return process(stamp, {target}).targets[0];
  }

  Image<float> depth_ = scene_depth(slab_camera(), 0.0);
  std::vector<double> positions_{0.0};
  Pipeline pipeline_;
};

}  // namespace penumbra::test
