// SPDX-License-Identifier: Apache-2.0
// Real robots against Embree: DESIGN.md section 5, accuracy.
#include "data.hpp"
#include "embree_oracle.hpp"
#include "render_test.hpp"
#include "shapes.hpp"

#include <penumbra/robot/robot.hpp>

namespace penumbra::test {
namespace {

using Eigen::Quaterniond;

/// Where a random camera stands.
enum class ViewKind {
  outside,      ///< 0.6 m to 2.5 m away
  eye_in_hand,  ///< on the last link, looking anywhere
  at_the_skin,  ///< less than 1.2 cm before some surface, which the near plane cuts open
};

std::vector<Isometry3d> random_link_poses(std::mt19937_64& random, const Robot& robot) {
  std::vector<double> positions = robot.rest_positions();
  for (double& q : positions) q = uniform(random, -2.0, 2.0);
  std::vector<Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  return poses;
}

/// A point of the robot's surface and a direction away from it, seen from far away.
struct SurfacePoint {
  Vector3d position, outwards;
};

std::optional<SurfacePoint> random_surface_point(std::mt19937_64& random,
                                                 const std::vector<Body>& bodies,
                                                 const std::vector<Isometry3d>& T_root_link) {
  // A camera 3 m away that looks at a random link's origin.
  const Vector3d aim =
      T_root_link[random() % T_root_link.size()].translation() + 0.05 * random_direction(random);
  const Vector3d towards = random_direction(random);
  const Quaterniond rotation = turn(towards, Vector3d::UnitZ());
  const Isometry3d T_eye_root = Translation3d(0, 0, 3) * rotation * Translation3d(-aim);
  std::vector<Isometry3d> poses = T_root_link;
  for (Isometry3d& pose : poses) pose = T_eye_root * pose;
  const auto hit = EmbreeOracle(bodies, poses).first_hit(Vector3d::UnitZ(), 0.01);
  if (!hit) return std::nullopt;
  return SurfacePoint{T_eye_root.inverse() * Vector3d(0, 0, hit->z), -towards};
}

/// The camera at `position` in which the ray of a random pixel passes through `target`.
Isometry3d aimed_camera(std::mt19937_64& random, const Intrinsics& intrinsics,
                        const Vector3d& position, const Vector3d& target) {
  const double u = uniform(random, 0.2, 0.8) * intrinsics.width();
  const double v = uniform(random, 0.2, 0.8) * intrinsics.height();
  const Quaterniond aim = turn(target - position, intrinsics.ray(u, v));
  const AngleAxisd roll(uniform(random, -M_PI, M_PI), intrinsics.ray(u, v).normalized());
  return roll * aim * Translation3d(-position);
}

std::optional<Isometry3d> random_camera(std::mt19937_64& random, const std::vector<Body>& bodies,
                                        const Intrinsics& intrinsics,
                                        const std::vector<Isometry3d>& T_root_link, ViewKind kind) {
  const auto seen = random_surface_point(random, bodies, T_root_link);
  if (!seen) return std::nullopt;
  switch (kind) {
    case ViewKind::outside:
      return aimed_camera(random, intrinsics,
                          seen->position + seen->outwards * uniform(random, 0.6, 2.5),
                          seen->position);
    case ViewKind::eye_in_hand:
      return aimed_camera(random, intrinsics,
                          T_root_link.back() * (0.09 * random_direction(random)), seen->position);
    case ViewKind::at_the_skin:
      return aimed_camera(random, intrinsics,
                          seen->position + seen->outwards * uniform(random, 0.001, 0.012),
                          seen->position + 0.05 * random_direction(random));
  }
  return std::nullopt;
}

/// Loads "ur5e" or "xarm7" from the data folder.
Robot load_robot(const std::string& name, Geometry geometry) {
  const auto folder = data_folder() / "robots" / name;
  return Robot::load(folder / (name + ".urdf"), {.geometry = geometry});
}

/// One body per link, without the pipeline, which a tree for the renderer's tests leaves out. Valid
/// as long as the robot.
std::vector<Body> link_bodies(const Robot& robot) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], robot.meshes(i)});
  return bodies;
}

/// A camera of random focal length, its principal point up to half an image outside of the image.
Intrinsics random_intrinsics(std::mt19937_64& random, int width, int height) {
  const double fx = uniform(random, 0.5, 1.6) * width, fy = fx * uniform(random, 0.9, 1.1);
  const double cx = uniform(random, -0.5, 1.5) * width;
  return {width, height, fx, fy, cx, uniform(random, -0.5, 1.5) * height};
}

/// T_camera_link of every link: random joint positions, and a random camera in which some pixel
/// sees the robot, and whose centre is in no link.
std::vector<Isometry3d> random_view(std::mt19937_64& random, const Robot& robot,
                                    const std::vector<Body>& bodies, const Intrinsics& intrinsics,
                                    ViewKind kind) {
  for (;;) {
    std::vector<Isometry3d> poses = random_link_poses(random, robot);
    const auto T_camera_root = random_camera(random, bodies, intrinsics, poses, kind);
    if (!T_camera_root) continue;
    for (Isometry3d& pose : poses) pose = *T_camera_root * pose;
    if (!EmbreeOracle(bodies, poses).camera_is_inside()) return poses;
  }
}

constexpr int views_per_camera = 5;

/// Share of the robot's pixels that OpenGL may show wrongly; seen: 1e-7 with llvmpipe. Its grid of
/// 1/256 pixel lets faces seen edge-on, thinner than the grid, cover a pixel's centre that they
/// miss by some thousandths of a pixel, where the judge's rays need not meet them.
constexpr double edge_on_limit = 1e-6;

/// Most pixels that a backend may show wrongly.
std::size_t most_errors(const BackendChoice& choice, const Agreement& total) {
  if (choice.backend != Backend::gl) return 0;
  return std::size_t(edge_on_limit * double(total.robot_pixels));
}

struct RobotCase {
  std::string name;
  Geometry geometry;
};

std::ostream& operator<<(std::ostream& out, const RobotCase& robot) {
  return out << robot.name << (robot.geometry == Geometry::visual ? "_visual" : "_collision");
}

class RobotAgainstEmbree : public ::testing::TestWithParam<RobotCase> {};

/// Two cameras outside for each eye-in-hand and each one at the skin.
ViewKind kind_of(int view) {
  const int kind = view % views_per_camera;
  return kind == 3 ? ViewKind::eye_in_hand : kind == 4 ? ViewKind::at_the_skin : ViewKind::outside;
}

/// Compares every backend's images of one random camera.
void compare_views(std::mt19937_64& random, const Robot& robot, std::vector<Agreement>& totals) {
  const std::vector<BackendChoice> choices = usable_backend_choices(1);
  const std::vector<Body> bodies = link_bodies(robot);
  const Intrinsics intrinsics = random_intrinsics(random, 640, 480);
  std::vector<std::unique_ptr<DepthRenderer>> renderers;
  renderers.reserve(choices.size());
  for (const BackendChoice& choice : choices) renderers.push_back(make(choice, intrinsics, bodies));
  for (int view = 0; view < views_per_camera; ++view) {
    const ViewKind kind = kind_of(view);
    const auto poses = random_view(random, robot, bodies, intrinsics, kind);
    const EmbreeOracle oracle(bodies, poses);
    const OracleImage expected = cast_image(oracle, intrinsics);
    for (std::size_t i = 0; i < renderers.size(); ++i) {
      const VirtualDepthView rendered = renderers[i]->render(poses);
      expect_consistent(rendered, intrinsics, bodies.size());
      totals[i] += compare(rendered, oracle, expected, intrinsics);
    }
  }
}

TEST_P(RobotAgainstEmbree, RandomPosesAndCameras) {
  PENUMBRA_REQUIRE_DATA();
  const Robot robot = load_robot(GetParam().name, GetParam().geometry);
  std::mt19937_64 random = seeded_random(101);
  const int cameras = measures_in_full() ? 20 : sanitized ? 1 : 2;
  const std::vector<BackendChoice> choices = usable_backend_choices(1);
  std::vector<Agreement> totals(choices.size());
  for (int camera = 0; camera < cameras; ++camera) compare_views(random, robot, totals);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    std::cout << choices[i] << ": " << totals[i] << '\n';
    EXPECT_LE(totals[i].errors, most_errors(choices[i], totals[i])) << choices[i];
    EXPECT_LT(totals[i].differing_share(), differing_limit) << choices[i];
    EXPECT_GT(totals[i].robot_pixels, 10000U);
  }
}

TEST_P(RobotAgainstEmbree, AWindowShowsWhatTheWholeImageShows) {
  PENUMBRA_REQUIRE_DATA();
  const Robot robot = load_robot(GetParam().name, GetParam().geometry);
  std::mt19937_64 random = seeded_random(102);
  const std::vector<Body> bodies = link_bodies(robot);
  const Intrinsics intrinsics = random_intrinsics(random, 320, 240);
  std::vector<std::array<std::unique_ptr<DepthRenderer>, 2>> renderers;
  for (const BackendChoice& choice : usable_backend_choices(1))
    renderers.push_back({make(choice, intrinsics, bodies), make(choice, intrinsics, bodies)});
  for (int view = 0; view < views_per_camera; ++view) {
    const auto poses = random_view(random, robot, bodies, intrinsics, kind_of(view));
    const int u0 = int(random() % 300), v0 = int(random() % 220);
    const PixelRectangle window{u0, v0, std::min(u0 + 60, 320), std::min(v0 + 40, 240)};
    for (const auto& [whole, part] : renderers) {
      const VirtualDepthView expected = whole->render(poses), seen = part->render(poses, window);
      std::size_t different = 0;
      for (const auto [u, v] : each_pixel(window.u0, window.v0, window.u1, window.v1))
        different +=
            seen.depth(u, v) != expected.depth(u, v) || seen.links(u, v) != expected.links(u, v);
      EXPECT_EQ(different, 0U);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotAgainstEmbree,
                         ::testing::Values(RobotCase{"ur5e", Geometry::collision},
                                           RobotCase{"ur5e", Geometry::visual},
                                           RobotCase{"xarm7", Geometry::collision},
                                           RobotCase{"xarm7", Geometry::visual}),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace penumbra::test
