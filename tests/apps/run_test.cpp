// SPDX-License-Identifier: Apache-2.0
#include "fixtures.hpp"

#include <set>

#include <penumbra/base/version.hpp>
#include <penumbra/labels/labels.hpp>

#include <io/files/npy.hpp>

namespace penumbra::test {
namespace {

/// The contract of DESIGN section 4: keys and types that do not depend on the recording.
void expect_report(const Json& report) {
  EXPECT_EQ(keys(report),
            (Words{"penumbra", "input", "renderer", "settings", "links", "frames", "summary"}));
  EXPECT_EQ(keys(report["renderer"]), (Words{"backend", "isa", "threads", "device"}));
  const Words stages{"kinematics", "render", "classify", "targets"};
  for (const Json& frame : report["frames"]) {
    EXPECT_EQ(keys(frame), (Words{"index", "stamp_ns", "joint_age_ms", "status", "message",
                                  "pixels", "timing_ms", "attached", "targets"}));
    EXPECT_EQ(frame["message"].is_null(), frame["status"] == "ok");
    EXPECT_EQ(keys(frame["pixels"]),
              (Words{"robot", "front", "occluded", "unknown", "beyond", "fringe", "uncovered"}));
    EXPECT_EQ(keys(frame["timing_ms"]), stages);
    EXPECT_TRUE(frame["timing_ms"]["targets"].is_null());
    EXPECT_EQ(frame["targets"], Json::array());
  }
  EXPECT_EQ(report["summary"]["frames"], report["frames"].size());
  EXPECT_EQ(keys(report["summary"]["timing_ms"]), stages);
  EXPECT_EQ(keys(report["summary"]["timing_ms"]["render"]), (Words{"median", "p99", "max"}));
}

using RunTest = TinyTest;

TEST_F(RunTest, ATargetThatALinkCarriesIsHeld) {
  write_file(path("recording.yaml"),
             read_file(path("recording.yaml")) +
                 "attached: [{name: part, link: board, box: [0.1, 0.1, 0.1], "
                 "pose: [0.3, -0.2, 0, 0, 0, 0, 1], frames: [1, 2]}]\n");
  write_file(path("targets.yaml"), "targets:\n- {name: part, box: [1, 1, 3, 3]}\n");
  const Outcome outcome = run({"--targets", path("targets.yaml"), "--save", "overlay"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 held"), std::string::npos) << outcome.out;
  const Json json = report();
  for (const std::size_t i : {0U, 1U, 2U}) {
    const Json& target = json["frames"][i]["targets"][0];
    EXPECT_EQ(target["verdict"] == "held", i == 1) << target;
    if (i != 1) continue;
    EXPECT_EQ(target["reason"], "it is attached to link 'board'");
    EXPECT_TRUE(target["covered"].is_null());
  }
  EXPECT_EQ(json["summary"]["targets"][0]["verdicts"]["held"], 1);
}

TEST_F(RunTest, WritesDepthAndPointsWithoutTheRobot) {
  const Outcome outcome = run({"--save", "labels,filtered,points", "--points-frame", "base"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  Image<std::uint16_t> depth, filtered;
  io::read_png(path("depth_0.png"), depth).require();
  io::read_png(out() / "filtered" / "000000.png", filtered).require();
  const Image<std::uint8_t> label = labels("000000.png");
  std::size_t kept = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const bool is_kept = is_trusted(static_cast<Label>(label.data()[i]));
    ASSERT_EQ(filtered.data()[i], is_kept ? depth.data()[i] : 0) << i;
    kept += filtered.data()[i] > 0 ? 1 : 0;
  }
  ASSERT_GT(kept, 0U);
  const std::string pcd = read_file(out() / "points" / "000000.pcd");
  const std::string ply = read_file(out() / "points" / "000000.ply");
  const std::size_t point_bytes = pcd.find("rgb") == std::string::npos ? 12 : 16;
  EXPECT_NE(pcd.find("\nPOINTS " + std::to_string(kept) + "\nDATA binary\n"), std::string::npos);
  EXPECT_EQ(pcd.size(), pcd.find("DATA binary\n") + 12 + kept * point_bytes);
  EXPECT_NE(ply.find("element vertex " + std::to_string(kept) + "\n"), std::string::npos);
  EXPECT_EQ(ply.size(), ply.find("end_header\n") + 11 + kept * (point_bytes == 16 ? 15 : 12));
  EXPECT_EQ(pcd.substr(pcd.find("DATA binary\n") + 12, 12),
            ply.substr(ply.find("end_header\n") + 11, 12));
}

TEST_F(RunTest, WritesTheReportOfAGoodRecording) {
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "") << "nothing is said in a pipe where nothing is wrong";
  const Json json = report();
  expect_report(json);
  EXPECT_EQ(json["links"], (Json{"base", "board"}));
  EXPECT_EQ(json["renderer"]["backend"], "cpu");
  EXPECT_TRUE(json["renderer"]["device"].is_null());
  EXPECT_EQ(json["summary"]["bad_frames"], 0);
  EXPECT_EQ(json["summary"]["missing_links"], Json::array());
  ASSERT_EQ(json["frames"].size(), 3U);
  for (const Json& frame : json["frames"]) {
    EXPECT_EQ(frame["status"], "ok");
    EXPECT_TRUE(frame["stamp_ns"].is_null());
    EXPECT_TRUE(frame["joint_age_ms"].is_null());
    EXPECT_EQ(frame["pixels"]["front"], 64) << "the object of 8 x 8 pixels";
    EXPECT_EQ(frame["pixels"]["unknown"], 32) << "the hole of 4 x 8 pixels";
    EXPECT_EQ(frame["pixels"]["beyond"], 0);
    EXPECT_GT(frame["timing_ms"]["render"], 0.0);
  }
  EXPECT_EQ(json["summary"]["pixels"]["front"], 192);
  EXPECT_FALSE(fs::exists(out() / "labels"));
}

TEST_F(RunTest, SavesWhatIsAskedFor) {
  const Outcome outcome = run({"--save", "vdi,labels,links,overlay", "--renderer", "reference"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(report()["renderer"]["backend"], "reference");
  for (const char* name : {"000000", "000001", "000002"}) {
    Image<float> vdi;
    Image<std::uint16_t> links;
    Image<Rgb8> overlay;
    io::read_npy(out() / "vdi" / (std::string(name) + ".npy"), vdi).require();
    io::read_png(out() / "links" / (std::string(name) + ".png"), links).require();
    io::read_png(out() / "overlay" / (std::string(name) + ".png"), overlay).require();
    const Image<std::uint8_t> image = labels((std::string(name) + ".png").c_str());
    EXPECT_EQ(overlay.width(), tiny_width);
    for (int v = 0; v < tiny_height; ++v) {
      for (int u = 0; u < tiny_width; ++u) {
        ASSERT_EQ(links(u, v), vdi(u, v) > 0.0F ? 2 : 0);
        ASSERT_EQ(image(u, v) != 0, vdi(u, v) > 0.0F);
      }
    }
    EXPECT_EQ(image(28, 24), 1);
    EXPECT_EQ(image(38, 24), 3);
    EXPECT_EQ(image(33, 24), 2);
  }
}

TEST_F(RunTest, GoesOnAfterFaultyFrames) {
  fs::remove(path("depth_0.png"));
  write_file(path("joint_states.csv"), "frame,slide\n0,0.0\n1,far\n2,0.1\n");
  const Outcome outcome = run({"--save", "vdi,labels"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 2U) << "one line for each kind:\n" << outcome.err;
  const Json json = report();
  expect_report(json);
  EXPECT_EQ(json["summary"]["bad_frames"], 2);
  EXPECT_EQ(json["frames"][0]["status"], "missing_depth");
  EXPECT_NE(json["frames"][0]["message"].get<std::string>().find("depth_0.png"), std::string::npos);
  EXPECT_EQ(json["frames"][0]["pixels"]["unknown"], tiny_width * tiny_height);
  EXPECT_GT(json["frames"][0]["pixels"]["robot"], 0);
  EXPECT_EQ(json["frames"][1]["status"], "missing_joints");
  EXPECT_TRUE(json["frames"][1]["pixels"]["robot"].is_null());
  EXPECT_TRUE(json["frames"][1]["timing_ms"]["render"].is_null());
  EXPECT_EQ(json["frames"][1]["pixels"]["unknown"], tiny_width * tiny_height);
  EXPECT_EQ(json["frames"][2]["status"], "ok");
  EXPECT_FALSE(fs::exists(out() / "vdi/000001.npy")) << "there is none without a pose";
  const Image<std::uint8_t> image = labels("000001.png");
  EXPECT_EQ(std::set<std::uint8_t>(image.data(), image.data() + image.size()),
            std::set<std::uint8_t>{3});
}

TEST_F(RunTest, GapsInTheJointFileAreFaultyFrames) {
  write_file(path("joint_states.csv"), "frame,slide\n0,0.0\n2,0.1\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  expect_has(outcome.err, {"joint_states.csv", "frame 1"});
  const Json json = report();
  expect_report(json);
  ASSERT_EQ(json["frames"].size(), 3U);
  EXPECT_EQ(json["frames"][1]["index"], 1);
  EXPECT_EQ(json["frames"][1]["status"], "missing_joints");

  write_file(path("joint_states.csv"), "frame,slide\n0,0.0\n1,0.05\n");
  expect_has(run().err, {"joint_states.csv", "frame 2"});
  EXPECT_EQ(report()["frames"][2]["status"], "missing_joints");
  EXPECT_EQ(run({"--frames", ":2"}).err, "") << "the frame is not asked for";
}

TEST_F(RunTest, OnlyTheFrameIsBadWhoseJointsPutTheCameraInsideOfALink) {
  // From slide = -1.05 to -0.95 the board, 0.1 m thick, holds the camera's centre.
  write_file(path("joint_states.csv"), "frame,slide\n0,0.0\n1,-1.0\n2,0.1\n");
  const Outcome outcome = run({"--save", "vdi,labels"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  expect_has(outcome.err, {"'board'"});
  const Json json = report();
  expect_report(json);
  EXPECT_EQ(json["summary"]["bad_frames"], 1);
  EXPECT_EQ(json["frames"][1]["status"], "missing_transform");
  EXPECT_TRUE(json["frames"][1]["pixels"]["robot"].is_null());
  EXPECT_EQ(json["frames"][2]["status"], "ok");
  EXPECT_FALSE(fs::exists(out() / "vdi/000001.npy"));
  const Image<std::uint8_t> image = labels("000001.png");
  EXPECT_EQ(std::set<std::uint8_t>(image.data(), image.data() + image.size()),
            std::set<std::uint8_t>{3});
}

TEST_F(RunTest, ACameraInsideOfALinkInEveryFrameIsTheInputsFault) {
  write_file(path("joint_states.csv"), "frame,slide\n0,-1.0\n1,-1.0\n2,-1.0\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2);
  expect_has(outcome.err, {"ignore_links"});
}

TEST_F(RunTest, TakesARangeOfFrames) {
  ASSERT_EQ(run({"--frames", "1:3", "--save", "labels"}).status, 0);
  const Json json = report();
  ASSERT_EQ(json["frames"].size(), 2U);
  EXPECT_EQ(json["frames"][0]["index"], 1);
  EXPECT_FALSE(fs::exists(out() / "labels/000000.png"));
  EXPECT_TRUE(fs::exists(out() / "labels/000002.png"));

  ASSERT_EQ(run({"--frames", ":1", "--save", "labels"}).status, 0);
  EXPECT_TRUE(fs::exists(out() / "labels/000000.png"));
  EXPECT_FALSE(fs::exists(out() / "labels/000002.png")) << "an earlier run's image";
}

TEST_F(RunTest, StampsAreToldWhereTheyAreKnown) {
  write_file(path("joint_states.csv"),
             "frame,stamp,slide\n0,1700000000123456789,0.0\n1,1700000000223456789,0.05\n");
  ASSERT_EQ(run().status, 0);
  EXPECT_EQ(report()["frames"][0]["stamp_ns"], 1700000000123456789);
  EXPECT_EQ(report()["frames"][0]["joint_age_ms"], 0.0);

  write_file(path("joint_states.csv"), "frame,stamp,slide\n0,5,0.0\n1,6,far\n");
  ASSERT_EQ(run().status, 0);
  EXPECT_EQ(report()["frames"][1]["stamp_ns"], 6);
  EXPECT_TRUE(report()["frames"][1]["joint_age_ms"].is_null()) << "of joints that are missing";
}

TEST_F(RunTest, OptionsComeBeforeTheRecordingBeforeTheDefault) {
  const auto front = [&] { return report()["frames"][0]["pixels"]["front"].get<int>(); };
  edit_file(path("recording.yaml"), "  parent:", "  tolerance: [0.6, 0.0, 0.0]\n  parent:");
  ASSERT_EQ(run().status, 0);
  EXPECT_EQ(front(), 0) << "the recording's tolerance";
  ASSERT_EQ(run({"--labels", "paper"}).status, 0);
  EXPECT_EQ(front(), 64);
  ASSERT_EQ(run({"--tolerance", "0.02,0,0"}).status, 0);
  EXPECT_EQ(front(), 64);
  ASSERT_EQ(run({"--tolerance", "0.02,0,0", "--front-min-width", "9"}).status, 0);
  EXPECT_EQ(front(), 0) << "the object is 8 pixels wide";
}

TEST_F(RunTest, TheReportSaysByWhichRuleItWasMade) {
  const LabelRule rule;
  ASSERT_EQ(run().status, 0);
  Json settings = report()["settings"];
  const Json range = {0.0, nullptr};
  EXPECT_EQ(settings, (Json{{"tolerance", {rule.tolerance.a, rule.tolerance.b, rule.tolerance.c}},
                            {"front_min_width", rule.front_min_width},
                            {"edge_margin", rule.edge_margin},
                            {"fringe_reach", rule.fringe_reach},
                            {"beyond_factor", rule.beyond_factor},
                            {"labels", "full"},
                            {"beyond", "occluded"},
                            {"targets", nullptr},
                            {"target_history_s", 0.0},
                            {"bag", nullptr},
                            {"range", range},
                            {"image", "raw"},
                            {"geometry", "collision"},
                            {"geometry_fallback", false},
                            {"margins", Json::object()},
                            {"extra", Json::array()},
                            {"ignore_links", Json::array()},
                            {"only_links", Json::array()}}));

  edit_file(path("recording.yaml"), "  parent:",
            "  tolerance: [0.03, 0.0, 0.001]\n  range: [0.25, 4.0]\n  beyond: visible\n  parent:");
  edit_file(path("recording.yaml"), "  urdf: tiny.urdf",
            "  urdf: tiny.urdf\n  geometry: {board: collision}\n  margins: {board: 0.01}");
  ASSERT_EQ(run({"--labels", "paper", "--image", "rectified"}).status, 0);
  settings = report()["settings"];
  EXPECT_EQ(settings["labels"], "paper");
  EXPECT_EQ(settings["front_min_width"], 0);
  EXPECT_EQ(settings["image"], "rectified");
  EXPECT_EQ(settings["range"], (Json{0.25, 4.0}));
  EXPECT_EQ(settings["beyond"], "visible");
  EXPECT_EQ(settings["geometry"],
            (Json{{"default", "collision"}, {"links", {{"board", "collision"}}}}));
  EXPECT_EQ(settings["margins"], (Json{{"board", 0.01}}));
}

TEST_F(RunTest, RectifiedImagesHaveTheirOwnSize) {
  edit_file(path("camera_info.yaml"), "d: [0.0", "d: [-0.2");
  for (const char* image : {"raw", "rectified"}) {
    const Outcome outcome = run({"--image", image, "--save", "vdi,labels,overlay"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    Image<float> vdi;
    io::read_npy(out() / "vdi/000000.npy", vdi).require();
    EXPECT_EQ(vdi.width() == tiny_width, std::string(image) == "raw");
    EXPECT_EQ(labels("000000.png").width(), vdi.width());
  }
}

TEST(Help, TellsExamplesOfEveryCommand) {
  for (const std::vector<std::string>& line : {std::vector<std::string>{"--help"},
                                               {"run", "--help"},
                                               {"render", "--help"},
                                               {"view-planning", "--help"},
                                               {"inspect", "--help"},
                                               {"doctor", "--help"}}) {
    const Outcome outcome = penumbra(line);
    EXPECT_EQ(outcome.status, 0);
    expect_has(outcome.out, {"Examples:"});
    EXPECT_EQ(outcome.err, "");
  }
  EXPECT_EQ(penumbra({"--version"}).out, "penumbra " PENUMBRA_VERSION "\n");
}

}  // namespace
}  // namespace penumbra::test
