// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"
#include "agreement.hpp"
#include "opengl.hpp"
#include "scene.hpp"

namespace penumbra::test {

/// Small, with a principal point off the centre and other focal lengths along u and v.
inline const Intrinsics small_camera(160, 120, 150.0, 155.0, 81.3, 57.9);

/// Smaller still, of scenes that pass through it.
inline const Intrinsics near_camera(96, 72, 80.0, 82.0, 47.0, 36.25);

struct BackendChoice {
  Backend backend = Backend::reference;
  std::string isa;
  int threads = 1;
};

inline const BackendChoice opengl{Backend::gl, "", 1};

std::ostream& operator<<(std::ostream& out, const BackendChoice& choice);

/// The reference, OpenGL, the cpu renderer with every SIMD target that this machine has, and the
/// best of them with 2 to max_threads threads.
[[nodiscard]] std::vector<BackendChoice> backend_choices(int max_threads);

/// Those of backend_choices() that this machine can draw with.
[[nodiscard]] std::vector<BackendChoice> usable_backend_choices(int max_threads);

[[nodiscard]] std::unique_ptr<DepthRenderer> make(const BackendChoice& choice,
                                                  const Intrinsics& intrinsics,
                                                  const std::vector<Body>& bodies);

/// A copy of a rendered frame that outlives the renderer's next call.
struct Frame {
  Image<float> depth;
  Image<std::uint16_t> links;

  explicit Frame(const VirtualDepthView& view);
  [[nodiscard]] VirtualDepthView view() const { return {depth.view(), links.view(), nullptr}; }
  [[nodiscard]] std::size_t covered() const;
};

/// A mesh without the triangles that have a corner above z: an open bowl, if it was closed.
[[nodiscard]] TriangleMesh cut_above(TriangleMesh mesh, float z);

/// Expects what holds of every frame: images of the camera's size, depths and links that are 0
/// together, nothing before the near plane, and nothing outside of the touched tiles.
void expect_consistent(const VirtualDepthView& view, const Intrinsics& intrinsics,
                       std::size_t bodies);

/// Expects every pixel to agree with a brute-force ray caster.
void expect_agrees_with_brute_force(const VirtualDepthView& view, const Scene& scene,
                                    const Intrinsics& intrinsics);

/// Expects two frames to have the same bits.
void expect_same_bits(const VirtualDepthView& a, const VirtualDepthView& b);

/// A test for each backend.
class RenderTest : public ::testing::TestWithParam<BackendChoice> {
 protected:
  void SetUp() override {
    if (!can_draw(GetParam().backend)) GTEST_SKIP() << no_opengl;
  }

  /// Renders once and expects a consistent frame.
  [[nodiscard]] static Frame render(const Intrinsics& intrinsics, const Scene& scene);
};

[[nodiscard]] std::string backend_name(const ::testing::TestParamInfo<BackendChoice>& info);

}  // namespace penumbra::test

/// Makes a RenderTest of that name for all backends.
#define PENUMBRA_RENDER_TEST(suite, max_threads)                                              \
  class suite : public penumbra::test::RenderTest {};                                         \
  INSTANTIATE_TEST_SUITE_P(Backends, suite,                                                   \
                           ::testing::ValuesIn(penumbra::test::backend_choices(max_threads)), \
                           penumbra::test::backend_name)
