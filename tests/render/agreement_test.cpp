// SPDX-License-Identifier: Apache-2.0
// The judge itself finds every kind of fault.
#include "brute_force_oracle.hpp"
#include "render_test.hpp"
#include "shapes.hpp"

namespace penumbra::test {
namespace {

// Inside the sphere's image, and inside the box's.
constexpr int sphere_u = 91, sphere_v = 63;
constexpr int box_u = 47, box_v = 57;

TEST(AgreementTest, FindsEveryKindOfFault) {
  Scene scene;
  scene.add(sphere(0.3F, 12), at(0.1, 0.05, 1.5));
  scene.add(box({0.4F, 0.1F, 0.1F}), at(-0.1, 0.1, 2.0) * AngleAxisd(0.4, Vector3d::UnitZ()));
  const BruteForceOracle oracle(scene.bodies(), scene.poses);
  const OracleImage image = cast_image(oracle, small_camera);
  Image<float> depths(small_camera.width(), small_camera.height());
  std::transform(image.depth.data(), image.depth.data() + depths.size(), depths.data(),
                 [](double z) { return float(z); });
  Image<std::uint16_t> links = image.links;
  const auto errors = [&] {
    return compare({depths.view(), links.view(), nullptr}, oracle, image, small_camera).errors;
  };
  struct Fault {
    const char* what;
    int u, v;
    float times;  // of the depth
    std::uint16_t link;
  };
  EXPECT_EQ(errors(), 0U);
  constexpr float no_depth = 0.0F, more = 1.0F + 2e-4F, less = 1.0F - 2e-4F;
  for (const auto& [what, u, v, times, link] :
       {Fault{"hole", sphere_u, sphere_v, no_depth, 0},
        {"too far", sphere_u, sphere_v, more, 1},
        {"too near", box_u, box_v, less, 2},
        {"wrong link", sphere_u, sphere_v, 1.0F, 2},
        {"depth without link", sphere_u, sphere_v, 1.0F, 0},
        {"link without depth", box_u, box_v, no_depth, 2}}) {
    const float depth = std::exchange(depths(u, v), times * depths(u, v));
    const std::uint16_t right = std::exchange(links(u, v), link);
    EXPECT_EQ(errors(), 1U) << what;
    depths(u, v) = depth;
    links(u, v) = right;
  }
  depths(5, 5) = 1.0F;
  links(5, 5) = 1;
  EXPECT_EQ(errors(), 1U) << "robot where there is none";
}

}  // namespace
}  // namespace penumbra::test
