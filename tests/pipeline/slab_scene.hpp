// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../robot/urdf_text.hpp"
#include "../support/test.hpp"

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

/// A robot of two boxes before the camera, whose depth a formula tells. The camera sits in the
/// root; "slab" moves along the optical axis with joint "slide", "plate" stands still beside it.
inline constexpr double slab_depth = 0.95;  // of its near face at slide = 0, metres
inline constexpr double wall_depth = 3.0;   // of what stands behind everything, metres

/// Metres at 1 m: float32 and the renderer's own formula.
inline constexpr double depth_tolerance = 1e-5;

inline constexpr auto unknown_label = std::uint8_t(Label::unknown);

inline std::string slab_urdf(const std::string& more = {}) {
  return robot_xml(
      link_xml("base") + link_xml("slab", box_xml("0.4 0.2 0.1")) +
          joint_xml("slide", "prismatic", "base", "slab",
                    R"(<origin xyz="0 0 1"/><axis xyz="0 0 1"/>
                                    <limit lower="-1" upper="1" effort="1" velocity="1"/>)") +
          link_xml("plate", box_xml("0.2 0.2 0.1")) +
          joint_xml("hold", "fixed", "base", "plate", R"(<origin xyz="0.5 0.1 1.5"/>)") + more,
      "slabs");
}
inline Robot slab_robot() { return parse(slab_urdf()); }

/// With another link, "lost", that is fixed to the root.
inline Robot slab_robot_without_mesh() {
  const std::string lost = link_xml("lost", collision_xml("<mesh filename=\"nowhere.stl\"/>")) +
                           joint_xml("weld", "fixed", "base", "lost");
  return parse(slab_urdf(lost), {.allow_missing_meshes = true});
}

/// A camera in the root's frame.
inline Camera camera_at_root(const Intrinsics& intrinsics) {
  Camera camera{intrinsics, {}, {}, {}};
  camera.T_parent_camera = Isometry3d::Identity();
  return camera;
}

/// Its principal point is off the centre, and no box edge meets a pixel centre.
inline Camera slab_camera() {
  return camera_at_root(Intrinsics(161, 121, 120.3, 118.7, 73.21, 57.43));
}

/// Nothing but the tolerance: 0.02 m everywhere, no clean-up.
inline PipelineConfig plain_config(Backend backend = Backend::cpu) {
  PipelineConfig config;
  config.backend = backend;
  config.rule.tolerance = {0.02, 0.0, 0.0};
  config.rule.front_min_width = 0;
  return config;
}

struct Seen {
  double depth = 0.0;  ///< metres; 0: no robot
  int link = 0;        ///< link image value
};

/// Another box of the scene, with axes along the root's.
struct SlabBox {
  Vector3d centre, size;  ///< metres, in the root's frame
  int link = 0;           ///< link image value
};

/// What the ray from the root's origin meets first, by intersecting boxes.
inline Seen cast(const Vector3d& ray, double slide, const std::vector<SlabBox>& more = {}) {
  std::vector<SlabBox> boxes = more;
  boxes.push_back({{0.0, 0.0, 1.0 + slide}, {0.4, 0.2, 0.1}, 2});
  boxes.push_back({{0.5, 0.1, 1.5}, {0.2, 0.2, 0.1}, 3});
  Seen seen;
  for (const auto& [centre, size, link] : boxes) {
    const double depth = enter_box(-centre, ray / ray.z(), size / 2).value_or(0.0);
    if (depth > 0.0 && (seen.depth == 0.0 || depth < seen.depth)) seen = {depth, link};
  }
  return seen;
}

/// Metres: the robot itself, and the wall where it is not.
inline Image<float> scene_depth(const Camera& camera, double slide,
                                const std::vector<SlabBox>& more = {}) {
  const Intrinsics& k = camera.intrinsics;
  Image<float> depth(k.width(), k.height());
  for (const auto [u, v] : each_pixel(k)) {
    const Seen seen = cast(k.ray(u, v), slide, more);
    depth(u, v) = float(seen.depth > 0.0 ? seen.depth : wall_depth);
  }
  return depth;
}

/// A frame with the slab at `slide`. The depth image must outlive it.
inline Frame frame_of(const Image<float>& depth, double slide = 0.0,
                      std::vector<Target> targets = {}, std::vector<AttachedBody> attached = {}) {
  return {.depth = depth.view(),
          .pose = {.positions = {slide}, .attached = std::move(attached)},
          .targets = std::move(targets)};
}

/// Expects every pixel to show what `cast` says of its ray.
template <typename Cast>
void expect_drawn(const VirtualDepthView& drawn, Cast&& cast_ray) {
  const Intrinsics k = slab_camera().intrinsics;
  ASSERT_EQ(drawn.depth.width, k.width());
  for (const auto [u, v] : each_pixel(k)) {
    const Seen seen = cast_ray(k.ray(u, v));
    ASSERT_NEAR(drawn.depth(u, v), seen.depth, depth_tolerance) << u << ',' << v;
    ASSERT_EQ(drawn.links(u, v), seen.link) << u << ',' << v;
  }
}

/// What the slab carries beside itself, and partly before it.
inline const Vector3d part_size(0.13, 0.11, 0.09);
inline AttachedBody body(const std::string& name, const std::string& link, const Vector3d& at) {
  return {name, link, std::make_shared<PreparedMesh>(make_box(part_size)), test::at(at)};
}
inline AttachedBody part(const std::string& name = "part") {
  return body(name, "slab", {0.19, 0.06, -0.08});
}
/// Where part() is.
inline SlabBox part_box(double slide = 0.0) {
  return {Vector3d(0.19, 0.06, 0.92 + slide), part_size, 4};
}
inline const PixelBox behind_part{101, 61, 4, 6};

inline Target region(const char* name, const Region& shape) {
  return {.name = name, .shape = RegionTarget{shape}};
}

/// The verdicts on a frame's targets, in their order.
inline void expect_verdicts(const FrameReport& report, std::initializer_list<Verdict> expected) {
  ASSERT_EQ(report.targets.size(), expected.size());
  const Verdict* verdict = expected.begin();
  for (const TargetReport& target : report.targets)
    EXPECT_EQ(target.verdict, *verdict++) << target.name << ": " << target.reason;
}

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
