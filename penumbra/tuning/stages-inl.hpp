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
  std::span<const KeptFrame> frames;
  const Intrinsics& camera;
  const Robot& robot;
  Image<float> background;  // metres: median of each pixel without the robot; 0: unknown

  /// Returns whether the depth is nearer than the background.
  [[nodiscard]] bool is_new(int u, int v, float z, const Tolerance& tolerance) const {
    const float far = background(u, v);
    return far > 0.0f && z > 0.0f && z < far - LabelRule::fringe_drift * tolerance.at(z);
  }
  /// Returns whether the same depth, or a nearer one, was measured without the robot.
  [[nodiscard]] bool is_background(int u, int v, float z) const {
    const float far = background(u, v);
    return far > 0.0f && z >= far - static_cast<float>(LabelRule().tolerance.at(far));
  }
};

[[nodiscard]] Scene make_scene(std::span<const KeptFrame> frames, const Intrinsics& camera,
                               const Robot& robot);

/// Labels a kept frame.
[[nodiscard]] inline LabelView label(Classifier& classifier, const KeptFrame& frame) {
  return classifier.classify({frame.virtual_depth.view(), {}, nullptr}, frame.depth.view());
}

/// Returns for each link whether it moves relative to the root.
[[nodiscard]] std::vector<bool> moving_links(std::span<const KeptFrame> frames);

/// Returns the pixels of the robot.
[[nodiscard]] NearestPixels robot_pixels(ImageView<const float> virtual_depth);

/// Returns the pixels where the sensor sees the robot.
[[nodiscard]] NearestPixels seen_robot(const LabelView& labels);

[[nodiscard]] ToleranceFit fit_tolerance(const Scene& scene, const LabelRule& current);

[[nodiscard]] std::vector<ExtraPart> find_extras(const Scene& scene, const LabelRule& rule);

/// Measures with the parts drawn.
[[nodiscard]] FringeFit fit_fringe(const Scene& scene, const LabelRule& rule,
                                   const std::vector<ExtraPart>& parts);

}  // namespace penumbra::tuning
