// SPDX-License-Identifier: Apache-2.0
// A graphics device that fails under the command line: a plain line, and what was done is kept.
#include "../support/opengl.hpp"
#include "../support/run_length.hpp"
#include "fixtures.hpp"

#include <algorithm>

namespace penumbra::test {
namespace {

constexpr int most_questions = 100;  // that OpenGL may be asked while three frames are drawn

class FailingDevice : public TinyTest {
 protected:
  void SetUp() override {
    if (sanitized) GTEST_SKIP() << "skipped: sanitized";  // it wants to be the first library
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
  }

  /// The device fails when it was asked for its state `spared` times.
  [[nodiscard]] Outcome run(int spared) const {
    return penumbra({"run", path(), "-o", out(), "--renderer", "gl", "--save", "labels"},
                    {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE,
                     "PENUMBRA_TEST_SPARED=" + std::to_string(spared)});
  }

  /// Frames in the report of a run that failed; 0 where there is none.
  [[nodiscard]] std::size_t expect_failed(const Outcome& outcome) const {
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("OpenGL: the graphics device was reset"), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("--renderer cpu"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("internal error"), std::string::npos) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    if (!std::filesystem::exists(out() / "report.json")) {
      EXPECT_FALSE(std::filesystem::exists(out() / "labels/000000.png"));
      return 0;
    }
    const Json report = Json::parse(read_file(out() / "report.json"));
    const std::string note = report["summary"]["notes"].back();
    const std::size_t frames = report["frames"].size();
    EXPECT_NE(note.find("frame " + std::to_string(frames) + " and later ones are not judged"),
              std::string::npos)
        << note;
    EXPECT_NE(outcome.err.find(note), std::string::npos) << outcome.err;
    EXPECT_EQ(report["summary"]["frames"], frames);
    for (const Json& frame : report["frames"]) EXPECT_EQ(frame["pixels"]["front"], 64);
    return frames;
  }
};

/// The device fails ever later until the run is done.
TEST_F(FailingDevice, LeavesTheFramesBefore) {
  std::vector<std::size_t> kept;
  for (int spared = 0; spared < most_questions; ++spared) {
    const Outcome outcome = run(spared);
    if (outcome.status == 0) break;
    kept.push_back(expect_failed(outcome));
  }
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const std::size_t frames : {0U, 1U, 2U})
    EXPECT_NE(std::count(kept.begin(), kept.end(), frames), 0) << frames;
  EXPECT_EQ(Json::parse(read_file(out() / "report.json"))["frames"].size(), 3U);
}

TEST_F(FailingDevice, IsNoFaultOfRender) {
  const Outcome outcome =
      render({"--renderer", "gl"},
             {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE, "PENUMBRA_TEST_SPARED=0"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_NE(outcome.err.find("penumbra: OpenGL: the graphics device was reset"), std::string::npos)
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(path("vdi.npy")));
}

}  // namespace
}  // namespace penumbra::test
