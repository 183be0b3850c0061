// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace penumbra::test {
namespace {

double enter(const SlabBox& box, const Eigen::Vector3d& ray) {
  double near = 0.0;
  double far = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.centre[axis] - box.size[axis] / 2) / ray[axis];
    const double b = (box.centre[axis] + box.size[axis] / 2) / ray[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near < far ? near : 0.0;
}

}  // namespace

std::string slab_urdf(const std::string& more) {
  return R"(<robot name="slabs">
  <link name="base"/>
  <link name="slab">
    <collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="slab"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <link name="plate">
    <collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision>
  </link>
  <joint name="hold" type="fixed">
    <parent link="base"/><child link="plate"/><origin xyz="0.5 0.1 1.5"/>
  </joint>)" +
         more + "</robot>";
}

Robot slab_robot() { return Robot::parse(slab_urdf(), "."); }

Camera slab_camera() {
  return {.intrinsics = Intrinsics(161, 121, 120.3, 118.7, 73.21, 57.43),
          .distortion = {},
          .range = {},
          .frame_id = {}};
}

PipelineConfig plain_config(Backend backend) {
  PipelineConfig config;
  config.backend = backend;
  config.rule.tolerance = {0.02, 0.0, 0.0};
  config.rule.front_min_width = 0;
  return config;
}

Seen cast(const Eigen::Vector3d& ray, double slide, const std::vector<SlabBox>& more) {
  std::vector<SlabBox> boxes = more;
  boxes.push_back({{0.0, 0.0, 1.0 + slide}, {0.4, 0.2, 0.1}, 2});
  boxes.push_back({{0.5, 0.1, 1.5}, {0.2, 0.2, 0.1}, 3});
  Seen seen;
  for (const SlabBox& box : boxes) {
    const double depth = enter(box, ray / ray.z());
    if (depth > 0.0 && (seen.depth == 0.0 || depth < seen.depth)) seen = {depth, box.link};
  }
  return seen;
}

Image<float> scene_depth(const Camera& camera, double slide, const std::vector<SlabBox>& more) {
  const Intrinsics& k = camera.intrinsics;
  Image<float> depth(k.width(), k.height());
  for (int v = 0; v < k.height(); ++v) {
    for (int u = 0; u < k.width(); ++u) {
      const Seen seen = cast(k.ray(u, v), slide, more);
      depth(u, v) = static_cast<float>(seen.depth > 0.0 ? seen.depth : wall_depth);
    }
  }
  return depth;
}

Image<std::uint16_t> to_millimetres(const Image<float>& metres) {
  Image<std::uint16_t> image(metres.width(), metres.height());
  std::transform(metres.data(), metres.data() + metres.size(), image.data(),
                 [](float z) { return static_cast<std::uint16_t>(std::lround(z * 1000.0F)); });
  return image;
}

}  // namespace penumbra::test
