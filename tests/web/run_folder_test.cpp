// SPDX-License-Identifier: Apache-2.0
// `penumbra view OUT`: nothing else is shown than what the run judged.
#include "../apps/program.hpp"
#include "../apps/tiny_recording.hpp"
#include "viewer_process.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include <io/files/png.hpp>

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

TEST_F(ViewRunTest, ShowsTheReport) {
  run({"--labels", "paper", "--frames", "1:3", "--save", "overlay,labels,links,vdi"});
  fs::remove_all(recording());  // it is not needed
  const ViewerProcess viewer({out()});
  const json session = viewer.complete_session();
  EXPECT_EQ(session["frames"], 2);
  EXPECT_EQ(session["camera"], nullptr);
  json report = json::parse(read_file(out() / "report.json"));
  EXPECT_EQ(session["links"], report["links"]);
  EXPECT_EQ(viewer.get_json("/api/report"), report);
  report["frames"].erase(0);
  EXPECT_EQ(viewer.get_json("/api/report?from=1"), report);
  const Packet first = packet(viewer, 0);
  EXPECT_EQ(first.json["frame"]["index"], 1);
  EXPECT_EQ(first.parts.size(), 4U);
  EXPECT_EQ(first.json["camera_pose"], nullptr);
}

TEST_F(ViewRunTest, SavedImagesAreShownAsTheyAre) {
  run({"--save", "labels"});
  Image<std::uint8_t> painted(tiny_width, tiny_height, 4);
  io::write_png(out() / "labels" / "000001.png", std::as_const(painted).view());
  const ViewerProcess viewer({out() / "report.json"});
  EXPECT_EQ(viewer.complete_session()["frames"], tiny_frames);
  EXPECT_EQ(packet(viewer, 1).parts.at("labels"), std::string(painted.size(), '\x04'));
}

TEST_F(ViewRunTest, ThePageSaysHowToGetTheRest) {
  run({"--save", "labels,overlay"});
  const ViewerProcess viewer({out()});
  const json session = viewer.complete_session();
  EXPECT_EQ(session["parts"], json({"overlay", "labels"}));
  ASSERT_EQ(session["missing"].size(), 2U);
  const std::string unsaved = session["missing"][0];
  EXPECT_NE(unsaved.find("links, vdi"), std::string::npos) << unsaved;
  EXPECT_NE(unsaved.find("--save overlay,labels,links,vdi"), std::string::npos) << unsaved;
  const std::string input = session["missing"][1];
  EXPECT_NE(input.find("penumbra view " + recording().string()), std::string::npos) << input;
  EXPECT_EQ(packet(viewer, 2).parts.size(), 2U);
}

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
                                                 {"--robot", "arm.urdf"},
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
    EXPECT_NE(outcome.err.find("not a report of penumbra run"), std::string::npos) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  }
}

}  // namespace
}  // namespace penumbra::test
