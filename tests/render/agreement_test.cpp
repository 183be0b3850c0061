// SPDX-License-Identifier: Apache-2.0
// The judges themselves: that they agree with each other, and find every kind of fault.
#include "brute_force_oracle.hpp"
#include "render_test.hpp"
#include "shapes.hpp"

#ifdef PENUMBRA_HAS_EMBREE
#include "embree_oracle.hpp"
#endif

namespace penumbra::test {
namespace {

class AgreementTest : public ::testing::Test {
 protected:
  AgreementTest() {
    scene_.add(sphere(0.3F, 12), at(0.1, 0.05, 1.5));
    scene_.add(box({0.4F, 0.1F, 0.1F}), at(-0.1, 0.1, 2.0) * AngleAxisd(0.4, Vector3d::UnitZ()));
    image_ = cast_image(oracle(), small_camera);
    depth_ = Image<float>(small_camera.width(), small_camera.height());
    for (std::size_t i = 0; i < depth_.size(); ++i)
      depth_.data()[i] = float(image_.depth.data()[i]);
    links_ = image_.links;
  }

  [[nodiscard]] BruteForceOracle oracle() const { return {scene_.bodies(), scene_.poses}; }
  [[nodiscard]] Agreement judge() const {
    return compare({depth_.view(), links_.view(), nullptr}, oracle(), image_, small_camera);
  }

  Scene scene_;
  OracleImage image_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
};

// Inside the sphere's image, and inside the box's; both found in the constructor's scene.
constexpr int sphere_u = 91, sphere_v = 63;
constexpr int box_u = 47, box_v = 57;

TEST_F(AgreementTest, TheSameImageAgrees) {
  const Agreement agreement = judge();
  EXPECT_EQ(agreement.errors, 0U);
  EXPECT_EQ(agreement.differing_share(), 0.0);
  EXPECT_EQ(image_.links(sphere_u, sphere_v), 1);
  EXPECT_EQ(image_.links(box_u, box_v), 2);
  EXPECT_GT(agreement.robot_pixels, 2000U);
  EXPECT_LT(agreement.worst_interior, 1e-7);
}

TEST_F(AgreementTest, FindsEveryKindOfFault) {
  struct Fault {
    const char* what;
    int u, v;
    float times;  // of the depth
    std::uint16_t link;
  };
  constexpr float no_depth = 0.0F, more = 1.0F + 2e-4F, less = 1.0F - 2e-4F;
  for (const auto& [what, u, v, times, link] :
       {Fault{"hole", sphere_u, sphere_v, no_depth, 0},
        {"too far", sphere_u, sphere_v, more, 1},
        {"too near", box_u, box_v, less, 2},
        {"wrong link", sphere_u, sphere_v, 1.0F, 2},
        {"depth without link", sphere_u, sphere_v, 1.0F, 0},
        {"link without depth", box_u, box_v, no_depth, 2}}) {
    const float depth = std::exchange(depth_(u, v), times * depth_(u, v));
    const std::uint16_t right = std::exchange(links_(u, v), link);
    EXPECT_EQ(judge().errors, 1U) << what;
    depth_(u, v) = depth;
    links_(u, v) = right;
  }
  depth_(5, 5) = 1.0F;
  links_(5, 5) = 1;
  EXPECT_EQ(judge().errors, 1U) << "robot where there is none";
}

#ifdef PENUMBRA_HAS_EMBREE
TEST_F(AgreementTest, EmbreeAgreesWithBruteForce) {
  std::mt19937_64 random = seeded_random(95);
  Agreement total;
  for (int round = 0; round < 10; ++round) {
    Scene scene;
    scene.add(triangle_soup(random, 20, 1.5F), at(0, 0, 0.8));
    scene.add(box({0.1F, 0.1F, 0.4F}), random_pose(random, {-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}));
    const BruteForceOracle brute(scene.bodies(), scene.poses);
    const OracleImage traced = cast_image(EmbreeOracle(scene.bodies(), scene.poses), small_camera);
    Image<float> depth(small_camera.width(), small_camera.height());
    for (std::size_t i = 0; i < depth.size(); ++i) depth.data()[i] = float(traced.depth.data()[i]);
    total += compare({depth.view(), traced.links.view(), nullptr}, brute,
                     cast_image(brute, small_camera), small_camera);
  }
  EXPECT_EQ(total.errors, 0U) << total;
  EXPECT_LE(total.worst_shift, edge_shift) << total;
  EXPECT_LE(total.differing_share(), differing_limit) << total;
}

TEST_F(AgreementTest, EmbreeTellsWhetherTheCameraIsInside) {
  EXPECT_FALSE(EmbreeOracle(scene_.bodies(), scene_.poses).camera_is_inside());
  scene_.poses[0] = at(0.1, 0.1, 0.1);
  EXPECT_TRUE(EmbreeOracle(scene_.bodies(), scene_.poses).camera_is_inside());
  scene_.poses[0] = at(0.2, 0.2, 0.2);
  EXPECT_FALSE(EmbreeOracle(scene_.bodies(), scene_.poses).camera_is_inside());
}
#endif

}  // namespace
}  // namespace penumbra::test
