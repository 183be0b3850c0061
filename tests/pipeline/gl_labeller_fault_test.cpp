// SPDX-License-Identifier: Apache-2.0
// A graphics device that fails while it labels: no spoilt labels may come.
#include "gl_faults.hpp"
#include "opengl.hpp"
#include "random.hpp"
#include "shapes.hpp"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include <penumbra/pipeline/gl/gl_labeller.hpp>

namespace penumbra::test {
namespace {

class GlLabelFaults : public testing::Test {
 protected:
  using Poses = std::vector<Eigen::Isometry3d>;
  using Counts = std::array<std::size_t, label_count>;

  void SetUp() override {
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
    std::mt19937_64 random = seeded_random(507);
    GlLabeller labeller(odd_camera, bodies_, {});
    for (int i = 0; i < GlLabeller::max_pending; ++i) {
      poses_.push_back({random_pose(random, {-0.2, -0.2, 0.6}, {0.2, 0.2, 1.2})});
      labeller.submit(poses_.back(), wall_.view());
      counts_.push_back(labeller.collect().image.pixels);
    }
  }

  /// Labels all frames ahead with a device that fails; whether it came to that.
  [[nodiscard]] bool fails_once(GlFault fault, int spared) const {
    GlLabeller labeller(odd_camera, bodies_, {});
    const InjectedFault injected(fault, spared);
    Attempts attempt;
    std::size_t pending = 0;
    const auto submit = [&](const Poses& poses) {
      labeller.submit(poses, wall_.view());
      ++pending;
    };
    for (const Poses& poses : poses_) attempt([&] { submit(poses); });
    for (std::size_t i = 0; i < pending; ++i) {
      attempt([&] { EXPECT_EQ(labeller.collect().image.pixels, counts_[i]) << i; });
    }
    for (const Poses& poses : poses_) attempt([&] { submit(poses); });
    EXPECT_EQ(attempt.failed(), injected.happened());
    return attempt.failed();
  }

  std::vector<TriangleMesh> meshes_{sphere(0.2F, 12)};
  std::vector<Body> bodies_{{"ball", meshes_}};
  Image<float> wall_{odd_camera.width(), odd_camera.height(), 0.9F};
  std::vector<Poses> poses_;
  std::vector<Counts> counts_;
};

TEST_F(GlLabelFaults, LetALabellerFailForGood) {
  ASSERT_NE(counts_[0], counts_[1]);
  for (const GlFault fault : all_gl_faults) {
    SCOPED_TRACE(to_string(fault));
    int spared = 0;
    while (fails_once(fault, spared)) ++spared;
    EXPECT_GE(spared, GlLabeller::max_pending);
  }
}

}  // namespace
}  // namespace penumbra::test
