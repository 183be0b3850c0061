// SPDX-License-Identifier: Apache-2.0
// Real robots against Embree: DESIGN.md section 5, accuracy.
#include "data.hpp"
#include "embree_oracle.hpp"
#include "random.hpp"
#include "render_test.hpp"
#include "robot_views.hpp"
#include "run_length.hpp"

#include <iostream>

namespace penumbra::test {
namespace {

constexpr int views_per_camera = 5;

/// Share of the robot's pixels that OpenGL may show wrongly; seen: 1e-7 with llvmpipe. Its grid of
/// 1/256 pixel lets faces seen edge-on, thinner than the grid, cover a pixel's centre that they
/// miss by some thousandths of a pixel, where the judge's rays need not meet them.
constexpr double edge_on_limit = 1e-6;

/// Most pixels that a backend may show wrongly.
std::size_t most_errors(const BackendChoice& choice, const Agreement& total) {
  if (choice.backend != Backend::gl) return 0;
  return static_cast<std::size_t>(edge_on_limit * static_cast<double>(total.robot_pixels));
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
  switch (view % views_per_camera) {
    case 3:
      return ViewKind::eye_in_hand;
    case 4:
      return ViewKind::at_the_skin;
    default:
      return ViewKind::outside;
  }
}

/// Compares every backend's images of one random camera.
void compare_views(std::mt19937_64& random, const Robot& robot, std::vector<Agreement>& totals) {
  const std::vector<BackendChoice> choices = usable_backend_choices(1);
  const std::vector<Body> bodies = link_bodies(robot);
  const Intrinsics intrinsics = random_intrinsics(random, 640, 480);
  std::vector<std::unique_ptr<DepthRenderer>> renderers;
  renderers.reserve(choices.size());
  for (const BackendChoice& choice : choices) {
    renderers.push_back(make(choice, intrinsics, bodies));
  }
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
  for (const BackendChoice& choice : usable_backend_choices(1)) {
    const auto whole = make(choice, intrinsics, bodies), part = make(choice, intrinsics, bodies);
    for (int view = 0; view < views_per_camera; ++view) {
      const auto poses = random_view(random, robot, bodies, intrinsics, kind_of(view));
      const int u0 = static_cast<int>(random() % 300), v0 = static_cast<int>(random() % 220);
      const PixelRectangle window{u0, v0, std::min(u0 + 60, 320), std::min(v0 + 40, 240)};
      const VirtualDepthView expected = whole->render(poses), seen = part->render(poses, window);
      std::size_t different = 0;
      for (int v = window.v0; v < window.v1; ++v)
        for (int u = window.u0; u < window.u1; ++u)
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
