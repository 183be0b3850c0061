// SPDX-License-Identifier: Apache-2.0
#include "fixtures.hpp"

#include <cstdlib>
#include <sstream>

#include <sys/wait.h>

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

/// Runs until Ctrl-C comes; a run that had not begun by then is repeated with more time.
TEST(Interrupt, LeavesTheReportOfTheFramesThatAreDone) {
  const TemporaryFolder folder;
  write_long_recording(folder.path());
  const std::filesystem::path out = folder.path() / "out", err = folder.path() / "err";
  int status = 0;
  for (const char* seconds : {"0.3", "1", "3", "10"}) {
    const std::string command = std::string("timeout --preserve-status -s INT ") + seconds + " '" +
                                PENUMBRA_PROGRAM + "' run '" + folder.path().string() + "' -o '" +
                                out.string() + "' --save labels >/dev/null 2>'" + err.string() +
                                "'";
    status = std::system(command.c_str());
    if (std::filesystem::exists(out / "report.json")) break;
  }
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const Json report = Json::parse(read_file(out / "report.json"));
  const std::size_t done = report["frames"].size();
  EXPECT_GT(done, 0U);
  EXPECT_LT(done, static_cast<std::size_t>(many_frames));
  EXPECT_EQ(report["summary"]["frames"], done);
  const std::string note = report["summary"]["notes"].back();
  EXPECT_NE(note.find("stopped after " + std::to_string(done)), std::string::npos) << note;
  EXPECT_NE(read_file(err).find(note), std::string::npos);
  std::size_t images = 0;
  for (const auto& entry : std::filesystem::directory_iterator(out / "labels"))
    images += entry.path().extension() == ".png" ? 1 : 100'000;  // nothing unfinished
  EXPECT_EQ(images, done);
}

}  // namespace
}  // namespace penumbra::test
