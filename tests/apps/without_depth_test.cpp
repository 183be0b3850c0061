// SPDX-License-Identifier: Apache-2.0
// penumbra run on a recording without depth images.
#include "fixtures.hpp"

#include <penumbra/labels/labels.hpp>

namespace penumbra::test {
namespace {

class WithoutDepthTest : public TinyTest {
 protected:
  WithoutDepthTest() {
    edit_file(path("recording.yaml"), "  depth: depth_%d.png\n", "");
    write_targets(
        "- {name: behind, point: [0, 0, 1.5], radius: 0.05, link: base}\n"
        "- {name: before, point: [0, 0, 0.5], radius: 0.02, link: base}\n"
        "- {name: region, box: [28, 20, 6, 6]}\n");
  }
};

TEST_F(WithoutDepthTest, VerdictsAndMasksComeFromTheModel) {
  expect_has(succeed(run({"--save", "vdi,labels,robot_mask,overlay", "--targets",
                          path("targets.yaml"), "--report"}))
                 .err,
             {"no depth camera"});
  const Json all = report();
  ASSERT_EQ(all["frames"].size(), 3U);
  for (const Json& frame : all["frames"])
    expect_values(frame, {{"/status", "ok"},
                          {"/pixels/unknown", frame["pixels"]["robot"]},
                          {"/targets/0/verdict", "hidden"},
                          {"/targets/0/blame/0/link", "board"},
                          {"/targets/1/verdict", "visible"},
                          {"/targets/2/verdict", "unknown"}});
  for (const std::size_t frame : {0U, 2U}) {
    const auto mask = read_image<std::uint8_t>(out("robot_mask") / numbered(frame));
    const Image<std::uint8_t> label = labels(frame);
    for (std::size_t i = 0; i < mask.size(); ++i)
      ASSERT_EQ(mask.data()[i] == 255,
                label.data()[i] == static_cast<std::uint8_t>(Label::unknown));
    EXPECT_GT(std::count(mask.data(), mask.data() + mask.size(), 255), 100);
  }
  EXPECT_TRUE(fs::exists(out("overlay/000000.png")));
  EXPECT_TRUE(fs::exists(out("report.html")));

  edit_file(path("recording.yaml"), "  color: color_%d.png\n", "");  // no images at all
  succeed(run({"--save", "robot_mask"}));
  EXPECT_EQ(report()["frames"].size(), 3U);
}

class BagWithoutDepth : public BagTest {
 protected:
  BagWithoutDepth() {
    bag_.remove("/camera/depth/image_rect_raw");
    bag_.rename("/camera/depth/camera_info", "/camera/color/camera_info");
    saves_ = "robot_mask,overlay";
  }
};

TEST_F(BagWithoutDepth, IsJudgedByItsColourImages) {
  succeed(penumbra({"run", path(), "-o", path("wanted"), "--save", "robot_mask"}));
  for (const Words& options : {Words{"--no-depth"}, Words{"--no-depth", "--color-topic",
                                                          "/camera/color/image_raw/compressed"}}) {
    const Outcome outcome = succeed(run(options));
    expect_has(outcome.out + outcome.err, {"no depth camera", "color: /camera/color/image_raw"});
    EXPECT_EQ(statuses(), (Words{"ok", "ok", "ok"}));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(read_file(out("robot_mask") / numbered(i)) ==
                  read_file(path("wanted/robot_mask") / numbered(i)))
          << i;
      EXPECT_TRUE(fs::exists(out("overlay") / numbered(i)));
    }
  }
  expect_failed(
      penumbra({"calibrate", tiny_mcap(), "-o", path("calibrated"), "--no-depth", "--search"}),
      {"--no-depth", "compares depth images"});
}

}  // namespace
}  // namespace penumbra::test
