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

  /// An environment in which the device fails when it was asked for its state `spared` times.
  static Words failing(int spared) {
    return {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE,
            "PENUMBRA_TEST_SPARED=" + std::to_string(spared)};
  }
  static void expect_device_failed(const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    expect_has(outcome.err, {"OpenGL: the graphics device was reset", "--renderer cpu"});
    expect_lacks(outcome.err, {"internal error"});
  }
  /// Frames in the report of a run that failed; 0 where there is none.
  [[nodiscard]] std::size_t frames_of(const Outcome& outcome) const {
    if (!fs::exists(out("report.json"))) {
      EXPECT_FALSE(fs::exists(out("labels/000000.png")));
      return 0;
    }
    const Json json = report();
    const std::string note = json["summary"]["notes"].back();
    const std::size_t frames = json["frames"].size();
    expect_has(note, {"frame " + std::to_string(frames) + " and later ones are not judged"});
    expect_has(outcome.err, {note});
    EXPECT_EQ(json["summary"]["frames"], frames);
    for (const Json& frame : json["frames"]) EXPECT_EQ(frame["pixels"]["front"], 64);
    return frames;
  }
};

/// The device fails ever later until the run is done.
TEST_F(FailingDevice, LeavesTheFramesBefore) {
  std::vector<std::size_t> kept;
  for (int spared = 0; spared < most_questions; ++spared) {
    const Outcome outcome = run({"--renderer", "gl", "--save", "labels"}, failing(spared));
    if (outcome.status == 0) break;
    expect_device_failed(outcome);
    kept.push_back(frames_of(outcome));
  }
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const std::size_t frames : {0U, 1U, 2U})
    EXPECT_NE(std::count(kept.begin(), kept.end(), frames), 0) << frames;
  EXPECT_EQ(report()["frames"].size(), 3U);
}

TEST_F(FailingDevice, IsNoFaultOfRender) {
  expect_device_failed(render({"--renderer", "gl"}, failing(0)));
  EXPECT_FALSE(fs::exists(path("vdi.npy")));
}

}  // namespace
}  // namespace penumbra::test
