// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <penumbra/tuning/nearest_pixel-inl.hpp>
#include <penumbra/tuning/tuning.hpp>

namespace penumbra::tuning {

inline constexpr std::size_t least_pixels = 500;  // for each measurement

/// The input of all stages.
struct Scene {
  std::span<const TuningFrame> frames;
  const Intrinsics& camera;
  const Robot& robot;
  Image<float> background;  // metres: median of each pixel without the robot; 0: unknown

  /// Returns whether the depth is nearer than the background.
  [[nodiscard]] bool is_new(int u, int v, float z, const Tolerance& tolerance) const {
    const float far = background(u, v);
    return far > 0.0f && z > 0.0f && z < far - LabelRule::fringe_drift * tolerance.at(z);
  }
};

[[nodiscard]] Scene make_scene(std::span<const TuningFrame> frames, const Intrinsics& camera,
                               const Robot& robot);

/// Labels the kept frames.
class Labeller {
 public:
  Labeller(const Scene& scene, const LabelRule& rule)
      : classifier_(scene.camera.width(), scene.camera.height(), rule) {}
  LabelView label(const TuningFrame& frame) {
    return classifier_.classify({frame.virtual_depth.view(), {}, nullptr}, frame.depth.view());
  }

 private:
  Classifier classifier_;
};

/// Returns the pixels where the sensor sees the robot.
[[nodiscard]] NearestPixels seen_robot(const LabelView& labels);

[[nodiscard]] ToleranceFit fit_tolerance(const Scene& scene, const LabelRule& current);

struct ExtraSearch {
  std::vector<ExtraPart> parts;
  std::vector<Image<std::uint8_t>> pixels;  // per frame: 1 where a part was seen
};
[[nodiscard]] ExtraSearch find_extras(const Scene& scene, const LabelRule& rule);

[[nodiscard]] FringeFit fit_fringe(const Scene& scene, const LabelRule& rule,
                                   const ExtraSearch& extras);

}  // namespace penumbra::tuning
