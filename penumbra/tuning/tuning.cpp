// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/base/error.hpp>
#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/tuning/stages-inl.hpp>

namespace penumbra {
namespace tuning {

Scene make_scene(std::span<const KeptFrame> frames, const Intrinsics& camera, const Robot& robot) {
  const int width = camera.width(), height = camera.height();
  Scene scene{frames, camera, robot, Image<float>(width, height)};
  std::vector<std::vector<float>> depths(scene.background.size());
  for (const KeptFrame& frame : frames) {
    const NearestPixels nearest = robot_pixels(frame.virtual_depth.view());
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
        if (frame.depth(u, v) > 0.0f && nearest.distance(u, v) > FringeFit::farthest)
          depths[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(u)]
              .push_back(frame.depth(u, v));
  }
  std::transform(depths.begin(), depths.end(), scene.background.data(), detail::median<float>);
  return scene;
}

NearestPixels robot_pixels(ImageView<const float> virtual_depth) {
  return {virtual_depth.width, virtual_depth.height,
          [&](int u, int v) { return virtual_depth(u, v) > 0.0f; }};
}

NearestPixels seen_robot(const LabelView& labels) {
  return {labels.labels.width, labels.labels.height, [&](int u, int v) {
            return labels.labels(u, v) == static_cast<std::uint8_t>(Label::occluded);
          }};
}

}  // namespace tuning

Tuning tune(std::span<const KeptFrame> frames, const Intrinsics& camera, const Robot& robot,
            const LabelRule& current) {
  check_enough(frames, "tune");
  const tuning::Scene scene = tuning::make_scene(frames, camera, robot);
  Tuning found;
  found.rule = current;
  found.tolerance = tuning::fit_tolerance(scene, current);
  found.rule.tolerance = found.tolerance.tolerance;
  found.extras = tuning::find_extras(scene, found.rule);
  found.fringe = tuning::fit_fringe(scene, found.rule, found.extras);
  found.rule.fringe_reach = found.fringe.reach;
  return found;
}

}  // namespace penumbra
