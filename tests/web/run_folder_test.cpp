// SPDX-License-Identifier: Apache-2.0
// `penumbra view OUT`: nothing else is shown than what the run judged. `penumbra cloud --port`: the
// tiny robot's board before a wall.
#include "../apps/fixtures.hpp"
#include "../apps/tiny_clouds.hpp"
#include "viewer_process.hpp"

namespace penumbra::test {
namespace {

using nlohmann::json;

constexpr std::size_t tiny_frames = 3;

constexpr const char* all_parts = "labels,links,vdi,depth,overlay,cloud";

using ViewRunTest = TinyTest;

TEST_F(ViewRunTest, ShowsTheReport) {
  succeed(run({"--labels", "paper", "--frames", "1:3", "--save", "overlay,labels,links,vdi"}));
  fs::remove(path("recording.yaml"));  // it is not needed
  const ViewerProcess viewer({out()});
  const json session = viewer.complete_session();
  EXPECT_EQ(session["frames"], 2);
  EXPECT_EQ(session["camera"], nullptr);
  json report = json::parse(read_file(out("report.json")));
  EXPECT_EQ(session["links"], report["links"]);
  EXPECT_EQ(viewer.get_json("/api/report"), report);
  report["frames"].erase(0);
  EXPECT_EQ(viewer.get_json("/api/report?from=1"), report);
  const Packet first = viewer.packet(0, all_parts);
  EXPECT_EQ(first.json["frame"]["index"], 1);
  EXPECT_EQ(first.parts.size(), 4U);
  EXPECT_EQ(first.json["camera_pose"], nullptr);
}

TEST_F(ViewRunTest, SavedImagesAreShownAsTheyAreAndThePageSaysHowToGetTheRest) {
  succeed(run({"--save", "labels,overlay"}));
  const Image<std::uint8_t> painted(tiny_width, tiny_height, 4);
  io::write_png(out("labels/000001.png"), painted.view());
  const ViewerProcess viewer({out("report.json")});
  const json session = viewer.complete_session();
  EXPECT_EQ(session["frames"], tiny_frames);
  EXPECT_EQ(viewer.packet(1, all_parts).parts.at("labels"), std::string(painted.size(), '\x04'));
  EXPECT_EQ(session["parts"], json({"overlay", "labels"}));
  ASSERT_EQ(session["missing"].size(), 2U);
  expect_has(session["missing"][0], {"links, vdi", "--save overlay,labels,links,vdi"});
  expect_has(session["missing"][1], {"penumbra view " + path().string()});
  EXPECT_EQ(viewer.packet(2, all_parts).parts.size(), 2U);
}

TEST_F(ViewRunTest, ImagesBehindALinkAreNotShown) {
  succeed(run({"--save", "labels,overlay"}));
  const TemporaryFolder elsewhere;
  fs::copy_file(out("overlay/000000.png"), elsewhere.path() / "secret.png");
  fs::remove(out("overlay/000000.png"));
  fs::create_symlink(elsewhere.path() / "secret.png", out("overlay/000000.png"));
  fs::rename(out("labels"), elsewhere.path() / "labels");
  fs::create_directory_symlink(elsewhere.path() / "labels", out("labels"));
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

TEST_F(ViewRunTest, ChoicesOfItsOwnAndOtherReportsAreRefused) {
  succeed(run());
  for (const Words& choice : {Words{"--labels", "paper"},
                              {"--geometry", "visual"},
                              {"--frames", "0:1"},
                              {"--renderer", "reference"},
                              {"--robot", "arm.urdf"},
                              {"--targets", "none"}})
    expect_refused(penumbra({"view", out(), choice[0], choice[1]}), {choice[0]});
  for (const char* const text : {"{}", "", "{\"penumbra\": ", "[1, 2]", "{\"input\": 3}"}) {
    write_file(out("report.json"), text);
    expect_refused(penumbra({"view", out()}), {"report.json"});
  }
}

using CloudViewTest = BagTest;

TEST_F(CloudViewTest, HasThePointsAndTheirLabels) {
  add_clouds(bag_);
  bag_.write_mcap(path("tiny.mcap"));
  ViewerProcess viewer({path("tiny.mcap"), "--topic", "/points"}, "cloud");
  ASSERT_NE(viewer.port(), 0);
  const json session = viewer.complete_session();
  EXPECT_EQ(session["parts"], json({"cloud"}));
  EXPECT_EQ(session["camera"], nullptr);
  EXPECT_EQ(session["frames"], 3);
  const json report = viewer.get_json("/api/report");
  ASSERT_EQ(report["frames"].size(), 3U);
  const json& points = report["frames"][1]["points"];
  EXPECT_EQ(points["occluded"], 1);
  EXPECT_EQ(points["front"], 1);
  EXPECT_EQ(points["clear"], 1);
  EXPECT_EQ(points["unknown"], 1);
  EXPECT_NE(report["summary"], nullptr);

  const Packet packet = viewer.packet(1, "cloud");
  EXPECT_EQ(packet.json["frame"], report["frames"][1]);
  EXPECT_EQ(packet.json["link_poses"].size(), session["links"].size());
  EXPECT_TRUE(packet.json["camera_pose"].is_array());
  const std::string& cloud = packet.parts.at("cloud");
  ASSERT_EQ(cloud.size(), 3 * 16U) << "what is no measurement is not shown";
  const std::array labels{Label::occluded, Label::front, Label::clear};
  for (std::size_t i = 0; i < labels.size(); ++i)
    EXPECT_EQ(cloud[16 * i + 12], static_cast<char>(labels.at(i)));
  EXPECT_EQ(packet.float_at("cloud", 8), on_board(1));
  EXPECT_EQ(viewer.end(), 0);
}

}  // namespace
}  // namespace penumbra::test
