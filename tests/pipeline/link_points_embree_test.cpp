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

/// Of a point's depth: surfaces that are so close to each other are one for the renderer.
constexpr double same_depth = 6e-4;

/// Pixels from an outline within which a point may be judged as its neighbour: the diagonal of the
/// pixels around it; that of the wider window in images that are resampled for a lens.
constexpr double outline_margin = 1.5, resampled_margin = 3.0;

/// Largest shares of all points in images; seen: 0.9 % and 6 %, with a lens 1.5 % and 9 %.
constexpr double most_wrongly_visible = 0.02, most_wrong = 0.1;

struct Oracle {
  EmbreeOracle rays;
  Camera camera;

  [[nodiscard]] std::optional<RayHit> hit(const Vector2d& pixel) const {
    const auto ray =
        camera.distortion.undistort(camera.intrinsics.ray(pixel.x(), pixel.y()).head<2>());
    return ray ? rays.first_hit({ray->x(), ray->y(), 1.0}, 0.0) : std::nullopt;
  }

  /// Null: another surface is at the same depth.
  [[nodiscard]] std::optional<bool> is_hidden(const Vector2d& pixel, double depth) const {
    const auto first = hit(pixel);
    if (!first) return false;
    if (first->z < depth * (1.0 - same_depth)) return true;
    constexpr double ray_rounding = 1e-5;  // Embree's float32
    return first->z < depth * (1.0 - ray_rounding) ? std::nullopt : std::optional(false);
  }

  /// Whether a point so few pixels away is judged so.
  [[nodiscard]] bool is_so_nearby(const PointView& view, double margin) const {
    for (const double radius : {0.5, 1.0})
      for (int i = 0; i < 16; ++i) {
        const double a = i * std::numbers::pi / 8;
        const Vector2d near = view.pixel + radius * margin * Vector2d(std::cos(a), std::sin(a));
        if (is_hidden(near, view.depth) != (view.verdict != Verdict::hidden)) return true;
      }
    return false;
  }
};

struct Tally {
  std::size_t seen = 0, hidden = 0, by_other_links = 0, undrawn = 0;
  std::size_t wrongly_visible = 0, wrongly_hidden = 0, wrong_link = 0, beyond_margin = 0;

  [[nodiscard]] std::size_t in_image() const { return seen + hidden + undrawn; }
  [[nodiscard]] double wrong_share() const {
    return double(wrongly_visible + wrongly_hidden + undrawn) / double(in_image());
  }
};

std::ostream& operator<<(std::ostream& out, const Tally& tally) {
  return out << tally.in_image() << " points in images, " << tally.hidden << " hidden ("
             << tally.by_other_links << " by other links); wrongly visible "
             << tally.wrongly_visible << ", wrongly hidden " << tally.wrongly_hidden << ", unknown "
             << tally.undrawn << ", another link " << tally.wrong_link
             << "; farther from an outline than the margin " << tally.beyond_margin;
}

void count(const PointView& view, std::size_t link, const Oracle& oracle, double margin,
           Tally& tally) {
  if (view.verdict == Verdict::out_of_view) return;
  if (view.verdict == Verdict::unknown) {
    ++tally.undrawn;
    return;
  }
  const bool is_hidden = view.verdict == Verdict::hidden;
  ++(is_hidden ? tally.hidden : tally.seen);
  tally.by_other_links += is_hidden && view.hidden_by != link + 1;
  const auto truth = oracle.is_hidden(view.pixel, view.depth);
  if (!truth) return;
  if (*truth == is_hidden) {
    tally.wrong_link += is_hidden && oracle.hit(view.pixel)->body + 1 != view.hidden_by;
    return;
  }
  ++(is_hidden ? tally.wrongly_hidden : tally.wrongly_visible);
  tally.beyond_margin += !oracle.is_so_nearby(view, margin);
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
    const Oracle oracle{EmbreeOracle(bodies, poses), camera};
    for (std::size_t link = 0; link < bodies.size(); ++link) {
      if (!robot.report()[link].drawn) continue;
      const auto points = points_on(robot, robot.links()[link], points_per_link);
      for (const PointView& seen :
           point_views(report, pipeline.report_camera(), robot.links()[link], points))
        count(seen, link, oracle, of.has_lens ? resampled_margin : outline_margin, tally);
    }
  }
  std::cout << of << ": " << tally << '\n';
  EXPECT_GT(tally.seen, 500U);
  EXPECT_GT(tally.hidden, 500U);
  EXPECT_EQ(tally.beyond_margin, 0U);
  EXPECT_LT(double(tally.wrongly_visible), most_wrongly_visible * double(tally.in_image()));
  EXPECT_LT(tally.wrong_share(), most_wrong);
}

const std::string ur5e = "robots/ur5e/ur5e.urdf", xarm7 = "robots/xarm7/xarm7.urdf";
INSTANTIATE_TEST_SUITE_P(
    Robots, LinkPointsAgainstEmbree,
    testing::Values(RobotCase{"shipped", ""}, RobotCase{"shipped", "", Geometry::visual},
                    RobotCase{"shipped", "", Geometry::collision, true}, RobotCase{"ur5e", ur5e},
                    RobotCase{"ur5e", ur5e, Geometry::visual}, RobotCase{"xarm7", xarm7},
                    RobotCase{"xarm7", xarm7, Geometry::visual},
                    RobotCase{"xarm7", xarm7, Geometry::visual, true}),
    testing::PrintToStringParamName());

}  // namespace
}  // namespace penumbra::test
