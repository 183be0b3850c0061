// SPDX-License-Identifier: Apache-2.0
// penumbra run on a recording without depth images.
#include "fixtures.hpp"

#include <penumbra/labels/labels.hpp>

namespace penumbra::test {
namespace {

class WithoutDepthTest : public TinyTest {
 protected:
  WithoutDepthTest() {
    std::string yaml = read_file(path("recording.yaml"));
    const std::string depth = "  depth: depth_%d.png\n";
    yaml.erase(yaml.find(depth), depth.size());
    write_file(path("recording.yaml"), yaml);
    write_file(path("targets.yaml"),
               "targets:\n"
               "- {name: behind, point: [0, 0, 1.5], radius: 0.05, link: base}\n"
               "- {name: before, point: [0, 0, 0.5], radius: 0.02, link: base}\n"
               "- {name: region, box: [28, 20, 6, 6]}\n");
  }
};

TEST_F(WithoutDepthTest, VerdictsAndMasksComeFromTheModel) {
  const Outcome outcome = run(
      {"--save", "vdi,labels,robot_mask,overlay", "--targets", path("targets.yaml"), "--report"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_has(outcome.err, {"no depth camera"});
  const Json all = report();
  ASSERT_EQ(all["frames"].size(), 3U);
  for (const Json& frame : all["frames"]) {
    EXPECT_EQ(frame["status"], "ok");
    EXPECT_EQ(frame["pixels"]["unknown"], frame["pixels"]["robot"]);
    EXPECT_EQ(frame["targets"][0]["verdict"], "hidden");
    EXPECT_EQ(frame["targets"][0]["blame"][0]["link"], "board");
    EXPECT_EQ(frame["targets"][1]["verdict"], "visible");
    EXPECT_EQ(frame["targets"][2]["verdict"], "unknown");
  }
  for (const char* number : {"000000", "000002"}) {
    Image<std::uint8_t> mask;
    io::read_png(out() / "robot_mask" / (std::string(number) + ".png"), mask).require();
    const Image<std::uint8_t> label = labels(std::string(number) + ".png");
    for (std::size_t i = 0; i < mask.size(); ++i)
      ASSERT_EQ(mask.data()[i] == 255,
                label.data()[i] == static_cast<std::uint8_t>(Label::unknown));
    EXPECT_GT(std::count(mask.data(), mask.data() + mask.size(), 255), 100);
  }
  EXPECT_TRUE(fs::exists(out() / "overlay" / "000000.png"));
  EXPECT_TRUE(fs::exists(out() / "report.html"));
}

TEST_F(WithoutDepthTest, NeedsNoImagesAtAll) {
  std::string yaml = read_file(path("recording.yaml"));
  const std::string color = "  color: color_%d.png\n";
  yaml.erase(yaml.find(color), color.size());
  write_file(path("recording.yaml"), yaml);
  const Outcome outcome = run({"--save", "robot_mask"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(report()["frames"].size(), 3U);
}

TEST_F(WithoutDepthTest, CalibrateAndTuneNeedDepth) {
  for (const char* command : {"calibrate", "tune"})
    expect_refused(penumbra({command, path(), "-o", out()}),
                   {"recording.yaml", "'depth' is missing", "compares depth images"});
}

/// The tiny bag without depth images.
class BagWithoutDepth : public BagTest {
 protected:
  BagWithoutDepth() {
    bag_.remove("/camera/depth/image_rect_raw");
    bag_.rename("/camera/depth/camera_info", "/camera/color/camera_info");
    saves_ = "robot_mask,overlay";
  }
};

TEST_F(BagWithoutDepth, IsJudgedByItsColourImages) {
  const Outcome refused = run();
  EXPECT_EQ(refused.status, 2);
  expect_has(refused.err, {"--no-depth"});
  for (const Words& options : {Words{"--no-depth"}, Words{"--no-depth", "--color-topic",
                                                          "/camera/color/image_raw/compressed"}}) {
    const Outcome outcome = run(options);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    expect_has(outcome.out + outcome.err, {"no depth camera", "color: /camera/color/image_raw"});
    const fs::path wanted = path("wanted");
    ASSERT_EQ(penumbra({"run", path(), "-o", wanted, "--save", "robot_mask"}).status, 0);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(status(static_cast<std::size_t>(i)), "ok");
      const std::string file = "robot_mask/00000" + std::to_string(i) + ".png";
      EXPECT_TRUE(read_file(out() / file) == read_file(wanted / file)) << file;
      EXPECT_TRUE(fs::exists(out() / "overlay" / ("00000" + std::to_string(i) + ".png")));
    }
  }
}

TEST_F(BagWithoutDepth, CalibrateRefuses) {
  bag_.write_mcap(path("tiny.mcap"));
  const Outcome outcome =
      penumbra({"calibrate", path("tiny.mcap"), "-o", out(), "--no-depth", "--search"});
  EXPECT_EQ(outcome.status, 2);
  expect_has(outcome.err, {"--no-depth", "compares depth images"});
}

}  // namespace
}  // namespace penumbra::test
