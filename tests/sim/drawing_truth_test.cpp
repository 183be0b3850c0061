// SPDX-License-Identifier: Apache-2.0
// Whether what MuJoCo draws is the truth: against closed forms, and against Penumbra's own
// rendering of the arm, which shares nothing with it but the URDF.
#include "../support/run_length.hpp"
#include "simulated.hpp"

#include <cmath>
#include <cstdlib>

namespace penumbra::test {
namespace {

using DrawingTruth = SimulationTest;

using Eigen::Isometry3d;
using Eigen::Vector3d;
using sim::ObjectTruth;
using sim::SimFrame;
using sim::Simulation;

// Float depth with 24 bits between 0.08 m and 12 m: 4e-6 m at 2 m, and as much again for single
// precision in MuJoCo's matrices and the rasteriser.
constexpr double depth_tolerance = 5e-5;      // metres
constexpr double least_union = 99.9;          // percent of robot pixels drawn by both
constexpr double surface_tolerance = 0.5e-3;  // metres: round parts have other facets there
constexpr int silhouette = 2;                 // pixels that tell nothing beside a depth step

/// Depth of the first point of a box about its own origin on the ray of a pixel; 0: missed.
double box_depth(const Isometry3d& T_camera_box, const Vector3d& half, const Vector3d& ray) {
  const Isometry3d T = T_camera_box.inverse();
  const Vector3d from = T.translation(), along = T.linear() * ray;
  double enter = 0.0, leave = 1e9;
  for (int k = 0; k < 3; ++k) {
    const double a = (-half[k] - from[k]) / along[k], b = (half[k] - from[k]) / along[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave ? enter : 0.0;
}

bool interior(const Image<std::uint8_t>& mask, int u, int v) {
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) {
      const int x = u + du, y = v + dv;
      if (x < 0 || y < 0 || x >= mask.width() || y >= mask.height()) return false;
      if (mask(x, y) != mask(u, v)) return false;
    }
  return true;
}

TEST_F(DrawingTruth, ParcelLiesWhereItsPoseSays) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Simulation simulation("conveyor", without_noise(seed));
    SimFrame frame;
    ASSERT_TRUE(simulation.next(frame));
    const ObjectTruth& parcel = frame.objects.at(0);
    ASSERT_GT(parcel.pixels_alone, 5000U);
    const Isometry3d T_camera_box = simulation.T_base_camera().inverse() * parcel.T_base_object;
    const Vector3d half = 0.5 * simulation.object_size();
    const Intrinsics& k = simulation.camera().intrinsics;
    std::size_t covered = 0, compared = 0;
    for (int v = 0; v < frame.ids.height(); ++v)
      for (int u = 0; u < frame.ids.width(); ++u) {
        const double expected = box_depth(T_camera_box, half, k.ray(u, v));
        covered += expected > 0.0 ? 1 : 0;
        if (!interior(parcel.alone, u, v)) continue;
        EXPECT_EQ(expected > 0.0, parcel.alone(u, v) == 1) << u << ' ' << v;
        if (frame.ids(u, v) != parcel.id) continue;
        EXPECT_NEAR(static_cast<double>(frame.true_depth(u, v)), expected, depth_tolerance)
            << u << ' ' << v;
        EXPECT_NEAR(frame.depth(u, v), 1000.0 * expected, 0.5 + 1000.0 * depth_tolerance);
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
  if (!(z > 0.0F)) return false;
  for (int y = v - silhouette; y <= v + silhouette; ++y)
    for (int x = u - silhouette; x <= u + silhouette; ++x) {
      if (x < 0 || y < 0 || x >= depth.width || y >= depth.height) return false;
      if (!(std::abs(depth(x, y) - z) < step * z)) return false;
    }
  return true;
}

struct Agreement {
  std::size_t both = 0, either = 0, same_link = 0, compared = 0, far_off = 0;
};

void compare(const SimFrame& frame, const VirtualDepthView& drawn, Agreement& all) {
  for (int v = 0; v < frame.ids.height(); ++v)
    for (int u = 0; u < frame.ids.width(); ++u) {
      const bool ours = drawn.depth(u, v) > 0.0F, theirs = frame.robot_ids(u, v) > 0;
      all.either += ours || theirs ? 1 : 0;
      if (!ours || !theirs) continue;
      ++all.both;
      all.same_link += drawn.links(u, v) == frame.robot_ids(u, v) ? 1 : 0;
      if (!smooth(drawn.depth, u, v) || !smooth(frame.robot_depth.view(), u, v)) continue;
      ++all.compared;
      const double off = std::abs(static_cast<double>(drawn.depth(u, v)) -
                                  static_cast<double>(frame.robot_depth(u, v)));
      all.far_off += off > surface_tolerance ? 1 : 0;
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
  std::cout << "intersection over union " << percent(all.both, all.either) << ", same link "
            << percent(all.same_link, all.both) << ", off by more than 0.5 mm " << all.far_off
            << " of " << all.compared << '\n';
  EXPECT_GT(percent(all.both, all.either), least_union);
  EXPECT_GT(percent(all.same_link, all.both), least_union);
  EXPECT_GT(all.compared, 10'000U);
  EXPECT_LT(percent(all.far_off, all.compared), 1e-2);
}

}  // namespace
}  // namespace penumbra::test
