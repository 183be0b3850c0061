// SPDX-License-Identifier: Apache-2.0
// Points on real robots against rays of Embree from the camera to each point.
#include "../support/data.hpp"
#include "../support/embree_oracle.hpp"
#include "../support/test.hpp"

#include <penumbra/pipeline/link_points.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::test {
namespace {

constexpr std::size_t points_per_link = 200;

/// Of a point's depth. Surfaces that are so close before a point are its own or not: Embree works
/// in float32, PointJudge::same_surface is in metres.
constexpr double same_depth = 3e-4, ray_rounding = 1e-5;

struct Tally {
  std::size_t visible = 0, hidden = 0, by_other_links = 0, coincident = 0, wrong = 0;
};

std::ostream& operator<<(std::ostream& out, const Tally& tally) {
  return out << tally.visible << " points visible, " << tally.hidden << " hidden ("
             << tally.by_other_links << " by other links), " << tally.wrong << " of them wrong, "
             << tally.coincident << " on coinciding surfaces";
}

void count(const PointView& view, std::size_t link, const EmbreeOracle& oracle,
           const Camera& camera, Tally& tally) {
  if (view.verdict == Verdict::out_of_view) return;
  const auto ray =
      camera.distortion.undistort(camera.intrinsics.ray(view.pixel.x(), view.pixel.y()).head<2>());
  ASSERT_TRUE(ray);
  const auto first = oracle.first_hit({ray->x(), ray->y(), 1.0}, 0.0);
  const double z = first ? first->z : inf;
  if (view.depth * (1.0 - same_depth) < z && z < view.depth * (1.0 - ray_rounding)) {
    ++tally.coincident;
    return;
  }
  const bool is_hidden = view.verdict == Verdict::hidden;
  ++(is_hidden ? tally.hidden : tally.visible);
  tally.by_other_links += is_hidden && view.hidden_by != link + 1;
  const bool truth = z < view.depth * (1.0 - ray_rounding);
  tally.wrong += is_hidden != truth || (truth && first->body + 1 != view.hidden_by);
}

struct RobotCase {
  std::string name, urdf;
  Geometry geometry = Geometry::collision;
  bool has_lens = false;
};

std::ostream& operator<<(std::ostream& out, const RobotCase& robot) {
  return out << robot.name << (robot.geometry == Geometry::visual ? "_visual" : "_collision")
             << (robot.has_lens ? "_lens" : "");
}

class LinkPointsAgainstEmbree : public testing::TestWithParam<RobotCase> {};

TEST_P(LinkPointsAgainstEmbree, RandomPosesAndCameras) {
  const RobotCase& of = GetParam();
  std::filesystem::path file =
      PENUMBRA_SOURCE_DIR "/examples/arm_over_table/arm_description/arm.urdf";
  if (!of.urdf.empty()) {
    PENUMBRA_REQUIRE_DATA();
    file = data_folder() / of.urdf;
  }
  const Robot robot = Robot::load(file, {.geometry = of.geometry, .geometry_fallback = true});
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], robot.meshes(i)});
  std::mt19937_64 random = seeded_random(302);
  Tally tally;
  const int views = measures_in_full() ? 40 : 6;
  for (int view = 0; view < views; ++view) {
    Camera camera{Intrinsics(640, 480, 611.4, 611.2, 326.4, 235.7)};
    if (of.has_lens) {
      constexpr std::array lens{-0.15, 0.05, 0.001, -0.001, 0.0};
      camera.distortion = Distortion("plumb_bob", lens);
    }
    std::vector<double> positions = robot.rest_positions();
    for (double& q : positions) q = uniform(random, -1.5, 1.5);
    std::vector<Isometry3d> poses(robot.links().size());
    robot.forward_kinematics(positions, poses);
    const Vector3d aim = poses[below(random, poses.size())].translation();
    camera.T_parent_camera =
        looking_at(aim + uniform(random, 0.7, 2.5) * random_direction(random), aim);
    PipelineConfig config;
    config.has_depth = false;
    Pipeline pipeline(robot, camera, config);
    const FrameReport& report = pipeline.process({.pose = {.positions = positions}});
    if (report.status != FrameStatus::ok) continue;  // the camera is inside of a link
    for (Isometry3d& pose : poses) pose = camera.T_parent_camera->inverse() * pose;
    const EmbreeOracle oracle(bodies, poses);
    const PointJudge judge(robot);
    for (std::size_t link = 0; link < bodies.size(); ++link) {
      if (!robot.report()[link].drawn) continue;
      const auto points = points_on(robot, robot.links()[link], points_per_link);
      for (const PointView& seen :
           judge.judge(report, pipeline.report_camera(), robot.links()[link], points))
        count(seen, link, oracle, camera, tally);
    }
  }
  std::cout << of << ": " << tally << '\n';
  EXPECT_GT(tally.visible, 500U);
  EXPECT_GT(tally.hidden, 500U);
  EXPECT_LT(tally.coincident, tally.visible / 20);
  EXPECT_EQ(tally.wrong, 0U);
}

const std::string ur5e = "robots/ur5e/ur5e.urdf", xarm7 = "robots/xarm7/xarm7.urdf";
INSTANTIATE_TEST_SUITE_P(
    Robots, LinkPointsAgainstEmbree,
    testing::Values(RobotCase{"shipped", ""}, RobotCase{"shipped", "", Geometry::collision, true},
                    RobotCase{"ur5e", ur5e}, RobotCase{"ur5e", ur5e, Geometry::visual},
                    RobotCase{"xarm7", xarm7}, RobotCase{"xarm7", xarm7, Geometry::visual, true}),
    testing::PrintToStringParamName());

}  // namespace
}  // namespace penumbra::test
