// SPDX-License-Identifier: Apache-2.0
// `penumbra view OUT`: nothing else is shown than what the run judged.
#include "../apps/program.hpp"
#include "../apps/tiny_recording.hpp"
#include "../support/opengl.hpp"
#include "../support/run_length.hpp"
#include "viewer_process.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include <io/png.hpp>

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t tiny_frames = 3;

class ViewRunTest : public testing::Test {
 protected:
  ViewRunTest() {
    fs::create_directories(recording());
    write_tiny_recording(recording());
  }

  fs::path recording() const { return folder_.path() / "recording"; }
  fs::path out() const { return folder_.path() / "out"; }
  void run(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", recording(), "-o", out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = penumbra(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  static Packet packet(const ViewerProcess& viewer, std::size_t i) {
    return Packet(viewer.client()
                      .get("/api/frames/" + std::to_string(i) +
                           "/packet?with=labels,links,vdi,depth,overlay,cloud")
                      .body);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ViewRunTest, ShowsTheReportAndWhatItsInputGives) {
  run({"--labels", "paper", "--frames", "1:3", "--geometry", "visual", "--geometry-fallback"});
  const ViewerProcess viewer({out()});
  const json session = viewer.complete_session();
  EXPECT_EQ(session["missing"], json::array());
  EXPECT_EQ(session["frames"], 2);
  json report = json::parse(read_file(out() / "report.json"));
  EXPECT_EQ(viewer.get_json("/api/report"), report);
  report["frames"].erase(0);
  EXPECT_EQ(viewer.get_json("/api/report?from=1"), report);
  const Packet first = packet(viewer, 0);
  EXPECT_EQ(first.json["frame"]["index"], 1);
  EXPECT_EQ(first.parts.size(), 6U);
  EXPECT_TRUE(first.json["camera_pose"].is_array());
}

TEST_F(ViewRunTest, SavedImagesAreShownAsTheyAre) {
  run({"--save", "labels"});
  Image<std::uint8_t> painted(tiny_width, tiny_height, 4);
  io::write_png(out() / "labels" / "000001.png", std::as_const(painted).view());
  const ViewerProcess viewer({out() / "report.json"});
  EXPECT_EQ(viewer.complete_session()["frames"], tiny_frames);
  EXPECT_EQ(packet(viewer, 1).parts.at("labels"), std::string(painted.size(), '\x04'));
}

TEST_F(ViewRunTest, WithoutItsInputWhatWasSavedIsShownAndTheRestTold) {
  run({"--save", "labels,overlay"});
  fs::remove_all(recording());
  const ViewerProcess viewer({out()});
  const json session = viewer.complete_session();
  EXPECT_EQ(session["parts"], json({"overlay", "labels"}));
  EXPECT_EQ(session["camera"], nullptr);
  EXPECT_EQ(session["frames"], tiny_frames);
  ASSERT_EQ(session["missing"].size(), 1U);
  const std::string missing = session["missing"][0];
  for (const std::string& word : {std::string("color"), std::string("depth"), std::string("vdi"),
                                  recording().string(), std::string("--input")})
    EXPECT_NE(missing.find(word), std::string::npos) << missing;
  const Packet served = packet(viewer, 2);
  EXPECT_EQ(served.parts.size(), 2U);
  EXPECT_EQ(served.json["camera_pose"], nullptr);
}

TEST_F(ViewRunTest, AnInputThatMovedIsNamed) {
  run();
  const fs::path moved = recording().parent_path() / "moved";
  fs::rename(recording(), moved);
  const ViewerProcess viewer({out(), "--input", moved});
  EXPECT_EQ(viewer.complete_session()["missing"], json::array());
  EXPECT_EQ(packet(viewer, 0).parts.size(), 6U);
}

// Another robot's pose, or another image, must not be shown beside this report.
TEST_F(ViewRunTest, FramesOfAnInputThatChangedAreNotShown) {
  run({"--save", "labels"});
  Image<std::uint16_t> changed(tiny_width, tiny_height, 700);
  io::write_png(recording() / "depth_2.png", std::as_const(changed).view());
  const ViewerProcess viewer({out()});
  const json session = viewer.complete_session();
  ASSERT_EQ(session["missing"].size(), 1U);
  const std::string missing = session["missing"][0];
  EXPECT_NE(missing.find("1 of 3 frames"), std::string::npos) << missing;
  EXPECT_NE(missing.find("first in its frame 2"), std::string::npos) << missing;
  EXPECT_NE(missing.find("penumbra run "), std::string::npos) << missing;
  EXPECT_EQ(packet(viewer, 1).parts.size(), 6U);
  const Packet different = packet(viewer, 2);
  EXPECT_EQ(different.parts.size(), 1U);
  EXPECT_TRUE(different.parts.contains("labels"));
  EXPECT_EQ(different.json["camera_pose"], nullptr);
}

TEST_F(ViewRunTest, AnInputThatEndsEarlierIsTold) {
  run();
  std::string rows = read_file(recording() / "joint_states.csv");
  rows.erase(rows.find_last_of('\n', rows.size() - 2) + 1);
  write_file(recording() / "joint_states.csv", rows);
  fs::remove(recording() / "depth_2.png");
  const ViewerProcess viewer({out()});
  EXPECT_EQ(viewer.complete_session()["missing"].size(), 1U);
}

#ifdef PENUMBRA_FAILING_DEVICE
// It is not the input that has fewer frames.
TEST_F(ViewRunTest, ADeviceThatFailsIsToldAsWhatItIs) {
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";  // it wants to be the first library
  if (!has_opengl()) GTEST_SKIP() << no_opengl;
  constexpr int most_questions = 40;  // that OpenGL is asked for a few frames
  run({"--renderer", "gl", "--gl-device", std::to_string(*working_device())});
  std::string missing;
  for (int spared = 1; spared < most_questions && missing.find(" on: ") == std::string::npos;
       ++spared) {
    const ViewerProcess viewer({out(), "--gl-device", std::to_string(*working_device())},
                               {std::string("LD_PRELOAD=") + PENUMBRA_FAILING_DEVICE,
                                "PENUMBRA_TEST_SPARED=" + std::to_string(spared)});
    missing = viewer.complete_session()["missing"].dump();
  }
  EXPECT_NE(missing.find("the graphics device was reset"), std::string::npos) << missing;
  EXPECT_EQ(missing.find("fewer frames"), std::string::npos) << missing;
}
#endif

TEST_F(ViewRunTest, ImagesBehindALinkAreNotShown) {
  run({"--save", "labels,overlay"});
  const TemporaryFolder elsewhere;
  fs::copy_file(out() / "overlay/000000.png", elsewhere.path() / "secret.png");
  fs::remove(out() / "overlay/000000.png");
  fs::create_symlink(elsewhere.path() / "secret.png", out() / "overlay/000000.png");
  fs::rename(out() / "labels", elsewhere.path() / "labels");
  fs::create_directory_symlink(elsewhere.path() / "labels", out() / "labels");
  const ViewerProcess viewer({out()});
  EXPECT_EQ(viewer.complete_session()["frames"], tiny_frames);
  const auto status_of = [&](const std::string& what) {
    const HttpReply reply = viewer.client().get("/api/frames/" + what);
    EXPECT_EQ(reply.body.find("PNG"), std::string::npos) << what;
    return reply.status;
  };
  EXPECT_EQ(status_of("0/packet?with=overlay"), 404);
  EXPECT_EQ(status_of("1/packet?with=labels"), 404);
  EXPECT_EQ(viewer.client().get("/api/frames/1/packet?with=overlay").status, 200);
}

TEST_F(ViewRunTest, ChoicesOfItsOwnAreRefused) {
  run();
  for (const std::vector<std::string>& choice : {std::vector<std::string>{"--labels", "paper"},
                                                 {"--geometry", "visual"},
                                                 {"--frames", "0:1"},
                                                 {"--renderer", "reference"},
                                                 {"--targets", "none"}}) {
    const Outcome outcome = penumbra({"view", out(), choice[0], choice[1]});
    EXPECT_EQ(outcome.status, 2) << choice[0];
    EXPECT_NE(outcome.err.find(choice[0]), std::string::npos) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  }
}

TEST_F(ViewRunTest, AReportThatIsNoneIsRefused) {
  run();
  for (const char* const text : {"{}", "", "{\"penumbra\": ", "[1, 2]", "{\"input\": 3}"}) {
    write_file(out() / "report.json", text);
    const Outcome outcome = penumbra({"view", out()});
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_NE(outcome.err.find("no report of penumbra run"), std::string::npos) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  }
}

}  // namespace
}  // namespace penumbra::test
