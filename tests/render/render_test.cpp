// SPDX-License-Identifier: Apache-2.0
#include "render_test.hpp"

#include "brute_force_oracle.hpp"

#include <penumbra/base/simd_target.hpp>

namespace penumbra::test {

std::vector<BackendChoice> backend_choices(int max_threads) {
  std::vector<BackendChoice> choices{{Backend::reference, "", 1}, {Backend::gl, "", 1}};
  for (const std::string& isa : simd_target_names()) choices.push_back({Backend::cpu, isa, 1});
  for (int threads = 2; threads <= max_threads; ++threads)
    choices.push_back({Backend::cpu, simd_target_names().front(), threads});
  return choices;
}

std::vector<BackendChoice> usable_backend_choices(int max_threads) {
  std::vector<BackendChoice> choices = backend_choices(max_threads);
  const auto lacking = [](const BackendChoice& choice) { return !can_draw(choice.backend); };
  if (std::erase_if(choices, lacking) > 0) std::cout << no_opengl << '\n';
  return choices;
}

std::unique_ptr<DepthRenderer> make(const BackendChoice& choice, const Intrinsics& intrinsics,
                                    const std::vector<Body>& bodies) {
  return make_depth_renderer(choice.backend, intrinsics, bodies,
                             {.threads = choice.threads, .isa = choice.isa});
}

Frame::Frame(const VirtualDepthView& view)
    : depth(view.depth.width, view.depth.height), links(view.links.width, view.links.height) {
  for (int v = 0; v < view.depth.height; ++v) {
    std::copy_n(view.depth.row(v), view.depth.width, depth.view().row(v));
    std::copy_n(view.links.row(v), view.links.width, links.view().row(v));
  }
}

std::size_t Frame::covered() const {
  return std::size_t(
      std::count_if(depth.data(), depth.data() + depth.size(), [](float z) { return z > 0.0F; }));
}

TriangleMesh cut_above(TriangleMesh mesh, float z) {
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    return std::ranges::any_of(triangle, [&](std::uint32_t v) { return mesh.vertices[v].z() > z; });
  });
  return mesh;
}

void expect_consistent(const VirtualDepthView& view, const Intrinsics& intrinsics,
                       std::size_t bodies) {
  ASSERT_EQ(view.depth.width, intrinsics.width());
  ASSERT_EQ(view.depth.height, intrinsics.height());
  ASSERT_EQ(view.links.width, intrinsics.width());
  ASSERT_EQ(view.links.height, intrinsics.height());
  ASSERT_NE(view.touched, nullptr);
  ASSERT_EQ(view.touched->width, intrinsics.width());
  ASSERT_EQ(view.touched->height, intrinsics.height());

  std::size_t faults = 0, covered = 0;
  for (const auto [u, v] : each_pixel(intrinsics)) {
    const float z = view.depth(u, v);
    const unsigned link = view.links(u, v);
    const bool empty = std::bit_cast<std::uint32_t>(z) == 0 && link == 0;
    const bool robot = std::isfinite(z) && link >= 1 && link <= bodies &&
                       z >= DepthRenderer::near_plane * (1 - interior_tolerance);
    if (!empty && !robot && ++faults < 5) {
      ADD_FAILURE() << "pixel (" << u << ", " << v << "): depth " << z << ", link " << link;
    }
    covered += empty ? 0 : 1;
  }
  EXPECT_EQ(faults, 0U);
  std::size_t covered_inside = 0;
  view.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (const auto [u, v] : each_pixel(u0, v0, u1, v1))
      covered_inside += view.links(u, v) != 0 ? 1 : 0;
  });
  EXPECT_EQ(covered_inside, covered) << "pixels outside of the touched tiles are not 0";
}

void expect_agrees_with_brute_force(const VirtualDepthView& view, const Scene& scene,
                                    const Intrinsics& intrinsics) {
  const BruteForceOracle oracle(scene.bodies(), scene.poses);
  const Agreement agreement = compare(view, oracle, cast_image(oracle, intrinsics), intrinsics);
  EXPECT_EQ(agreement.errors, 0U) << agreement;
}

void expect_same_bits(const VirtualDepthView& a, const VirtualDepthView& b) {
  ASSERT_EQ(a.depth.width, b.depth.width);
  ASSERT_EQ(a.depth.height, b.depth.height);
  std::size_t differing = 0;
  for (const auto [u, v] : each_pixel(a.depth)) {
    const bool same = std::bit_cast<std::uint32_t>(a.depth(u, v)) ==
                          std::bit_cast<std::uint32_t>(b.depth(u, v)) &&
                      a.links(u, v) == b.links(u, v);
    if (!same && ++differing == 1) {
      ADD_FAILURE() << "pixel (" << u << ", " << v << "): " << a.depth(u, v) << " of "
                    << a.links(u, v) << " against " << b.depth(u, v) << " of " << b.links(u, v);
    }
  }
  EXPECT_EQ(differing, 0U);
}

Frame RenderTest::render(const Intrinsics& intrinsics, const Scene& scene) {
  const auto renderer = make(GetParam(), intrinsics, scene.bodies());
  const VirtualDepthView view = renderer->render(scene.poses);
  expect_consistent(view, intrinsics, scene.poses.size());
  return Frame(view);
}

std::ostream& operator<<(std::ostream& out, const BackendChoice& choice) {
  out << to_string(choice.backend);
  if (choice.backend == Backend::cpu) out << '_' << choice.isa << "_threads" << choice.threads;
  return out;
}

std::string backend_name(const ::testing::TestParamInfo<BackendChoice>& info) {
  std::ostringstream name;
  name << info.param;
  return name.str();
}

}  // namespace penumbra::test
