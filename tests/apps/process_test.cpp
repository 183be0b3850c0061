// SPDX-License-Identifier: Apache-2.0
// The program as a process: its memory, and what Ctrl-C leaves.
#include "../support/data.hpp"
#include "../support/run_length.hpp"
#include "fixtures.hpp"

#include <iostream>

namespace penumbra::test {
namespace {

using Process = TinyTest;

TEST_F(Process, ARunOnTheRecordingStaysSmall) {
  PENUMBRA_REQUIRE_DATA();
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";
  constexpr double budget = 200.0;  // MB
  for (const char* save : {"labels", "vdi,labels,links,overlay"}) {
    const double peak =
        peak_memory_mb({"run", data_folder() / "xarm7_realsense", "-o", out(), "--save", save});
    std::cout << "--save " << save << ": " << peak << " MB\n";
    EXPECT_LT(peak, budget);
    EXPECT_GT(peak, 1.0) << "not measured";
  }
}

TEST_F(Process, TheDemosProgramRunsRecordingsOfImages) {
  const auto demo = [](const Words& arguments) {
    return penumbra(arguments, {}, PENUMBRA_DEMO_PROGRAM);
  };
  succeed(penumbra({"run", path(), "-o", out(), "--save", "labels,overlay"}));
  succeed(demo({"run", path(), "-o", path("demo"), "--save", "labels,overlay"}));
  for (const char* const name : {"labels/000000.png", "overlay/000000.png"})
    EXPECT_EQ(read_file(path("demo") / name), read_file(out(name)));
  expect_failed(demo({"run", path(), "-o", path("out.mcap")}), {"out.mcap", "images in a folder"});
  expect_failed(demo({"run", path("in.mcap"), "-o", path("other")}),
                {"in.mcap", "images in a folder"});
  expect_failed(demo({"view", path()}), {"view", "run"});
}

TEST_F(Process, AnInterruptLeavesTheReportOfTheFramesThatAreDone) {
  constexpr std::size_t many_frames = 20'000;  // the tiny recording's first one: seconds of work
  std::string joints = "frame,slide\n";
  for (std::size_t i = 0; i < many_frames; ++i) {
    joints += std::to_string(i) + ",0\n";
    const fs::path image = path("depth_" + std::to_string(i) + ".png");
    if (!fs::exists(image)) fs::create_symlink("depth_0.png", image);
  }
  write_joints(joints);
  edit_file(path("recording.yaml"), "  color: color_%d.png\n", "");
  const Outcome outcome =
      penumbra_interrupted({"run", path(), "-o", out(), "--save", "labels"},
                           [&](const auto&) { return fs::exists(out("labels/000000.png")); });
  ASSERT_EQ(outcome.status, 130);
  const Json json = report();
  const std::size_t done = json["frames"].size();
  EXPECT_GT(done, 0U);
  EXPECT_LT(done, many_frames);
  EXPECT_EQ(json["summary"]["frames"], done);
  const std::string note = json["summary"]["notes"].back();
  expect_has(note, {"stopped after " + std::to_string(done)});
  expect_has(outcome.err, {note});
  std::size_t images = 0;
  for (const auto& entry : fs::directory_iterator(out("labels")))
    images += entry.path().extension() == ".png" ? 1 : 100'000;  // nothing unfinished
  EXPECT_EQ(images, done);
}

}  // namespace
}  // namespace penumbra::test
