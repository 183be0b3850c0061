// SPDX-License-Identifier: Apache-2.0
// Whether what MuJoCo draws is the truth: against closed forms, and against Penumbra's own
// rendering of the arm, which shares nothing with it but the URDF.
#include "simulated.hpp"

namespace penumbra::test {
namespace {

using DrawingTruth = SimulationTest;

using sim::ObjectTruth;
using sim::SimFrame;
using sim::Simulation;

// Float depth with 24 bits between 0.08 m and 12 m: 4e-6 m at 2 m, and as much again for single
// precision in MuJoCo's matrices and the rasteriser.
constexpr double depth_tolerance = 5e-5;      // metres
constexpr double least_union = 99.9;          // percent of robot pixels drawn by both
constexpr double surface_tolerance = 0.5e-3;  // metres: round parts have other facets there
constexpr int silhouette = 2;                 // pixels that tell nothing beside a depth step

/// Whether a condition holds for all pixels up to `reach` away, and the image has them.
bool all_around(const auto& image, int u, int v, int reach, const auto& holds_at) {
  if (u < reach || v < reach || u + reach >= image.width || v + reach >= image.height) return false;
  for (const auto [x, y] : each_pixel(u - reach, v - reach, u + reach + 1, v + reach + 1))
    if (!holds_at(image(x, y))) return false;
  return true;
}

TEST_F(DrawingTruth, ParcelLiesWhereItsPoseSays) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Simulation simulation("conveyor", without_noise(seed));
    SimFrame frame;
    ASSERT_TRUE(simulation.next(frame));
    const ObjectTruth& parcel = frame.objects.at(0);
    ASSERT_GT(parcel.pixels_alone, 5000U);
    const Isometry3d T_box_camera = parcel.T_base_object.inverse() * simulation.T_base_camera();
    const Vector3d half = 0.5 * simulation.object_size();
    const Intrinsics& k = simulation.camera().intrinsics;
    std::size_t covered = 0, compared = 0;
    for (const auto [u, v] : each_pixel(frame.ids)) {
      const auto expected =
          enter_box(T_box_camera.translation(), T_box_camera.linear() * k.ray(u, v), half);
      covered += expected ? 1 : 0;
      const auto is_same = [here = parcel.alone(u, v)](auto one) { return one == here; };
      if (!all_around(parcel.alone.view(), u, v, 1, is_same)) continue;
      EXPECT_EQ(expected.has_value(), parcel.alone(u, v) == 1) << u << ' ' << v;
      if (!expected || frame.ids(u, v) != parcel.id) continue;
      EXPECT_NEAR(static_cast<double>(frame.true_depth(u, v)), *expected, depth_tolerance)
          << u << ' ' << v;
      EXPECT_NEAR(frame.depth(u, v), 1000.0 * *expected, 0.5 + 1000.0 * depth_tolerance);
      ++compared;
    }
    EXPECT_GT(compared, 4000U);
    // Half a pixel off would be a twentieth of the outline: the areas agree far better.
    EXPECT_NEAR(static_cast<double>(covered), static_cast<double>(parcel.pixels_alone),
                0.003 * static_cast<double>(covered));
  }
}

/// Whether all depths around are of one surface that is not so steep that the facets of round
/// parts, a tenth of a pixel off at their rims, make more than the tolerance.
bool smooth(ImageView<const float> depth, int u, int v) {
  constexpr float step = 0.003F;  // relative
  const float z = depth(u, v);
  return z > 0.0F && all_around(depth, u, v, silhouette,
                                [&](float one) { return std::abs(one - z) < step * z; });
}

struct Agreement {
  std::size_t both = 0, either = 0, same_link = 0, compared = 0, far_off = 0;
};

void compare(const SimFrame& frame, const VirtualDepthView& drawn, Agreement& all) {
  for (const auto [u, v] : each_pixel(frame.ids)) {
    const bool ours = drawn.depth(u, v) > 0.0F, theirs = frame.robot_ids(u, v) > 0;
    all.either += ours || theirs ? 1 : 0;
    if (!ours || !theirs) continue;
    ++all.both;
    all.same_link += drawn.links(u, v) == frame.robot_ids(u, v) ? 1 : 0;
    if (!smooth(drawn.depth, u, v) || !smooth(frame.robot_depth.view(), u, v)) continue;
    ++all.compared;
    const float off = std::abs(drawn.depth(u, v) - frame.robot_depth(u, v));
    all.far_off += static_cast<double>(off) > surface_tolerance ? 1 : 0;
  }
}

TEST_F(DrawingTruth, TheArmIsTheUrdfs) {
  const int frames = measures_in_full() ? 200 : 12;
  Simulation simulation("random", without_color(4, false));
  const Robot& robot = simulation.robot();
  const auto bodies = bodies_of(robot);
  const auto renderer = make_depth_renderer(Backend::cpu, simulation.camera().intrinsics, bodies);
  std::vector<Isometry3d> poses(robot.links().size());
  Agreement all;
  SimFrame frame;
  for (int i = 0; i < frames && simulation.next(frame); ++i) {
    robot.forward_kinematics(frame.true_joints, poses);
    for (Isometry3d& pose : poses) pose = simulation.T_base_camera().inverse() * pose;
    compare(frame, renderer->render(poses), all);
  }
  EXPECT_GT(percent(all.both, all.either), least_union);
  EXPECT_GT(percent(all.same_link, all.both), least_union);
  EXPECT_GT(all.compared, 10'000U);
  EXPECT_LT(percent(all.far_off, all.compared), 1e-2);
}

}  // namespace
}  // namespace penumbra::test
