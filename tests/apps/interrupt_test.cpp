// SPDX-License-Identifier: Apache-2.0
#include "fixtures.hpp"

#include <sstream>

namespace penumbra::test {
namespace {

constexpr int many_frames = 20'000;  // seconds of work

/// The tiny recording's first frame, over and over.
void write_long_recording(const std::filesystem::path& folder) {
  write_tiny_recording(folder);
  std::ostringstream joints;
  joints << "frame,slide\n";
  for (int i = 0; i < many_frames; ++i) {
    joints << i << ",0\n";
    const std::filesystem::path image = folder / ("depth_" + std::to_string(i) + ".png");
    if (!std::filesystem::exists(image)) std::filesystem::create_symlink("depth_0.png", image);
  }
  write_file(folder / "joint_states.csv", joints.str());
  edit_file(folder / "recording.yaml", "  color: color_%d.png\n", "");
}

TEST(Interrupt, LeavesTheReportOfTheFramesThatAreDone) {
  const TemporaryFolder folder;
  write_long_recording(folder.path());
  const std::filesystem::path out = folder.path() / "out";
  const Outcome outcome = penumbra_interrupted(
      {"run", folder.path(), "-o", out, "--save", "labels"},
      [&](const auto&) { return std::filesystem::exists(out / "labels" / "000000.png"); });
  ASSERT_EQ(outcome.status, 130);
  const Json report = Json::parse(read_file(out / "report.json"));
  const std::size_t done = report["frames"].size();
  EXPECT_GT(done, 0U);
  EXPECT_LT(done, static_cast<std::size_t>(many_frames));
  EXPECT_EQ(report["summary"]["frames"], done);
  const std::string note = report["summary"]["notes"].back();
  EXPECT_NE(note.find("stopped after " + std::to_string(done)), std::string::npos) << note;
  EXPECT_NE(outcome.err.find(note), std::string::npos);
  std::size_t images = 0;
  for (const auto& entry : std::filesystem::directory_iterator(out / "labels"))
    images += entry.path().extension() == ".png" ? 1 : 100'000;  // nothing unfinished
  EXPECT_EQ(images, done);
}

}  // namespace
}  // namespace penumbra::test
