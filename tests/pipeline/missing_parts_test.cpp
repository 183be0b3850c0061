// SPDX-License-Identifier: Apache-2.0
// Which links carry a part that the URDF lacks, in a scene whose depth a formula tells.
#include "slab_scene.hpp"

#include <penumbra/diagnosis/diagnosis.hpp>

namespace penumbra::test {
namespace {

/// What is said of a box of the slab's depth that touches the slab at slide = 0, and then is
/// carried along by a share of the slab's motion.
std::vector<std::string> said_of_a_box(double share) {
  const Camera camera = slab_camera();
  PipelineConfig config = plain_config();
  config.rule.fringe_reach = 40;
  Pipeline pipeline(slab_robot(), camera, config);
  SetupCheck check(pipeline.robot(), camera, 0);
  for (const double slide : {0.0, 0.1, 0.3, 0.2}) {
    const SlabBox box{{-0.35, 0.0, 1.0 + share * slide}, {0.3, 0.2, 0.1}, 0};
    const Image<float> depth = scene_depth(camera, slide, {box});
    check.add(pipeline.process(frame_of(depth, slide)), {});
  }
  return check.missing_parts(config.rule.fringe_reach);
}

TEST(MissingParts, NameTheLinkThatCarriesOne) {
  const std::vector<std::string> lines = said_of_a_box(1.0);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(holds(lines[0], "'slab'"));
}

TEST(MissingParts, AreNotWhatStandsStillWhereALinkWas) { EXPECT_TRUE(said_of_a_box(0.0).empty()); }

}  // namespace
}  // namespace penumbra::test
