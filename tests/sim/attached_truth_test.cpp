// SPDX-License-Identifier: Apache-2.0
// An object in the gripper of MuJoCo's arm: what of it is called clear or front, and what around it
// is called robot, with the object attached.
#include "simulated.hpp"

#include <penumbra/mesh/primitives.hpp>

namespace penumbra::test {
namespace {

/// The half of a box that sim::Solid::wedge is.
TriangleMesh wedge(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (const auto& [x, y] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {-0.5, 0.5}})
    for (const double z : {-0.5, 0.5})
      mesh.vertices.push_back(Eigen::Vector3d(x, y, z).cwiseProduct(size).cast<float>());
  mesh.triangles = {{0, 4, 2}, {1, 3, 5}, {0, 2, 3}, {0, 3, 1},
                    {2, 4, 5}, {2, 5, 3}, {4, 0, 1}, {4, 1, 5}};
  return mesh;
}

/// Pixels of all frames.
struct Counts {
  std::size_t seen = 0;         ///< of the object, not hidden
  std::size_t trusted = 0;      ///< of these, clear or front
  std::size_t drawn = 0;        ///< where Penumbra draws it
  std::size_t too_much = 0;     ///< of these, where the object is not on the ray
  std::size_t wrong_blame = 0;  ///< of the object's rays, where another link is drawn
};

void add(const sim::SimFrame& truth, const FrameReport& report, Counts& counts) {
  const sim::ObjectTruth& held = truth.objects.back();
  const auto number = report.attached.empty() ? 0 : report.attached[0] + 1;
  for (const auto [u, v] : each_pixel(truth.ids)) {
    const bool is_drawn = number > 0 && report.virtual_depth.links(u, v) == number;
    counts.drawn += is_drawn ? 1 : 0;
    counts.too_much += is_drawn && held.alone(u, v) == 0 ? 1 : 0;
    if (truth.ids(u, v) != held.id) continue;
    ++counts.seen;
    counts.trusted += is_trusted(static_cast<Label>(report.labels(u, v))) ? 1 : 0;
    counts.wrong_blame += is_drawn ? 0 : 1;
  }
}

Counts count(std::uint64_t seed, bool noisy, int frames) {
  sim::Simulation simulation("carry", without_color(seed, noisy));
  const Robot& robot = simulation.robot();
  Pipeline pipeline(robot, simulation.camera());
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  AttachedBody held{.name = "held", .link = "tool0", .mesh = {}};
  Counts counts;
  sim::SimFrame truth;
  for (int i = 0; i < frames && simulation.next(truth); ++i) {
    const sim::ObjectTruth& object = truth.objects.back();
    if (!held.mesh) {
      const Eigen::Vector3d& size = object.solid.size;
      held.mesh = std::make_shared<PreparedMesh>(
          object.solid.kind == sim::Solid::wedge ? wedge(size) : make_box(size));
      robot.forward_kinematics(truth.true_joints, poses);
      held.T_link_body = poses[*robot.find_link("tool0")].inverse() * object.T_base_object;
    }
    const std::vector<AttachedBody> attached{held};
    // Its given position is wrong, the handled one is not.
    const Target target{.name = held.name,
                        .shape = PointTarget{.frame = ReferenceFrame::root()},
                        .handling = PointTrackerConfig{}};
    const FrameReport& report =
        pipeline.process({.stamp = truth.stamp,
                          .depth = std::as_const(truth.depth).view(),
                          .pose = {.positions = truth.joints, .attached = attached},
                          .targets = {target}});
    add(truth, report, counts);
    const TargetReport& handled = report.targets[0];
    EXPECT_EQ(handled.verdict, Verdict::held);
    constexpr double rounding = 1e-9;  // metres; the joints have no noise
    EXPECT_LT((*handled.handled->position - object.T_base_object.translation()).norm(), rounding);
  }
  return counts;
}

using AttachedTruth = BothDepths;
INSTANTIATE_TEST_SUITE_P(Depth, AttachedTruth, testing::Bool(), depth_name);

TEST_P(AttachedTruth, TheHeldObjectIsNeitherClearNorFront) {
  const int frames = measures_in_full() ? 1000 : samples(60);
  constexpr double most = 0.5;               // percent
  for (const std::uint64_t seed : {2, 3}) {  // a box and a mesh
    const Counts counts = count(seed, GetParam(), frames);
    EXPECT_GT(counts.seen, static_cast<std::size_t>(100 * frames));
    EXPECT_LT(percent(counts.trusted, counts.seen), most);
    EXPECT_LT(percent(counts.too_much, counts.drawn), most);
    EXPECT_LT(percent(counts.wrong_blame, counts.seen), most);
  }
}

}  // namespace
}  // namespace penumbra::test
