// SPDX-License-Identifier: Apache-2.0
// Verdicts without depth, against rays that Embree casts.
#include "box_rays.hpp"

#include <penumbra/mesh/primitives.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::test {
namespace {

constexpr double much = 0.2;           // hidden by more is never visible
constexpr double share_limit = 0.005;  // by which shares may be off
constexpr double blame_limit = 0.98;   // of the links that hide most

/// A target with the rays to its pixels, and how far before them the robot must be to hide it.
struct Placed {
  Target target;
  std::vector<TargetRay> rays;
  double margin = 0.0;  // metres, besides the tolerance
};

/// Rays to the pixels for which `holds(u, v)`, at one depth.
template <typename Holds>
std::vector<TargetRay> rays_at(double z, const Isometry3d& T_root_camera, const Intrinsics& camera,
                               Holds holds) {
  std::vector<TargetRay> rays;
  for (const auto [u, v] : each_pixel(camera))
    if (holds(u, v)) rays.push_back({T_root_camera.linear() * camera.ray(u, v), z});
  return rays;
}

/// Targets of every kind around a point, which a part of the robot may hide.
std::vector<Placed> placed_at(const Vector3d& at, const Isometry3d& T_root_camera,
                              const Intrinsics& camera, std::mt19937_64& random) {
  std::vector<Placed> all;
  const BoxTarget box = random_box(random, at, 0.08, 0.2);
  const std::vector<TargetRay> to_box = rays_of(box, T_root_camera, camera);
  all.push_back({{.name = "box", .shape = box}, to_box});
  all.push_back({{.name = "mesh",
                  .shape = MeshTarget{std::make_shared<PreparedMesh>(make_box(box.size)), box.pose,
                                      ReferenceFrame::root()}},
                 to_box});
  const Vector3d seen = T_root_camera.inverse() * at;
  const Vector2d centre(camera.fx() * seen.x() / seen.z() + camera.cx(),
                        camera.fy() * seen.y() / seen.z() + camera.cy());
  const PixelBox pixels{std::round(centre.x()) - 20, std::round(centre.y()) - 15, 40, 30};
  all.push_back(
      {{.name = "region", .shape = RegionTarget{.region = pixels, .expected_depth = seen.z()}},
       rays_at(seen.z(), T_root_camera, camera, [&](int u, int v) {
         return u >= pixels.u && u < pixels.u + pixels.width && v >= pixels.v &&
                v < pixels.v + pixels.height;
       })});
  const Vector2d axes(uniform(random, 12, 30), uniform(random, 12, 30));
  all.push_back(
      {{.name = "keypoint",
        .shape = KeypointTarget{.pixel = centre, .semi_axes = axes, .expected_depth = seen.z()}},
       rays_at(seen.z(), T_root_camera, camera, [&](int u, int v) {
         return (Vector2d(u, v) - centre).cwiseQuotient(axes).squaredNorm() <= 1.0;
       })});
  const double radius = uniform(random, 0.03, 0.08);
  const double cosine = std::sqrt(1.0 - radius * radius / seen.squaredNorm());
  all.push_back({{.name = "point", .shape = PointTarget{at, radius, ReferenceFrame::root()}},
                 rays_at(seen.z(), T_root_camera, camera,
                         [&](int u, int v) {
                           return camera.ray(u, v).normalized().dot(seen.normalized()) >= cosine;
                         }),
                 radius});
  return all;
}

struct Counts {
  std::size_t judged = 0, hidden_much = 0, called_visible = 0, blamed = 0, blamed_right = 0;
};

void judge_scenes(const Robot& robot, int scenes, std::mt19937_64& random, Counts& counts) {
  LinkRays links(robot);
  Camera camera = forecast_camera();
  std::vector<Isometry3d> T(robot.links().size());
  for (int scene = 0; scene < scenes; ++scene) {
    std::vector<double> positions = robot.rest_positions();
    for (double& position : positions) position = uniform(random, -1.5, 1.5);
    robot.forward_kinematics(positions, T);
    links.place(T);
    PipelineConfig config;
    config.has_depth = false;
    camera.T_parent_camera = random_viewpoint(random);
    const Vector3d from = camera.pose().translation();
    const Vector3d link = T[random() % T.size()].translation();
    const Vector3d beside = random_triple(random, 1.0);
    const Vector3d at =
        link + uniform(random, -0.3, 0.6) * (link - from).normalized() + 0.1 * beside;
    const std::vector<Placed> placed = placed_at(at, camera.pose(), camera.intrinsics, random);
    Pipeline pipeline(robot, camera, config);
    Frame frame{.pose = {.positions = positions}};
    for (const Placed& each : placed)
      if (!each.rays.empty()) frame.targets.push_back(each.target);
    const FrameReport& report = pipeline.process(frame);
    ASSERT_EQ(report.status, FrameStatus::ok) << report.message;
    std::size_t number = 0;
    for (const Placed& each : placed) {
      if (each.rays.empty()) continue;
      const TargetReport& found = report.targets[number++];
      if (!found.judgement || found.verdict == Verdict::out_of_view) continue;
      Tolerance before = config.rule.tolerance;
      before.a += each.margin;
      const Truth truth = truth_of(each.rays, links, from, before);
      ++counts.judged;
      counts.hidden_much += truth.hidden > much;
      counts.called_visible += truth.hidden > much && found.verdict == Verdict::visible;
      EXPECT_NEAR(found.judgement->occluded, truth.hidden, share_limit)
          << each.target.name << ", scene " << scene << ", " << each.rays.size() << " pixels";
      if (truth.hidden < TargetThresholds{}.partial_enter) continue;
      ++counts.blamed;
      counts.blamed_right +=
          !found.judgement->blame.empty() &&
          report.links[found.judgement->blame.front().link] == robot.links()[truth.by];
    }
  }
}

TEST(WithoutDepthTruth, VerdictsAgreeWithRays) {
  std::mt19937_64 random = seeded_random(402);
  const int scenes = measures_in_full() ? 134 : 25;
  Counts counts;
  for (const Robot& robot : arms()) judge_scenes(robot, scenes, random, counts);
  std::cout << counts.judged << " targets, " << counts.hidden_much << " hidden by more than "
            << 100 * much << " %, of these visible " << counts.called_visible << "; blame right "
            << counts.blamed_right << " of " << counts.blamed << '\n';
  EXPECT_GT(counts.hidden_much, counts.judged / 20);
  EXPECT_EQ(counts.called_visible, 0U);
  EXPECT_GT(double(counts.blamed_right), blame_limit * double(counts.blamed));
}

}  // namespace
}  // namespace penumbra::test
