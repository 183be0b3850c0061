// SPDX-License-Identifier: Apache-2.0
// penumbra run, its report, its memory, and what Ctrl-C leaves.
#include "../support/data.hpp"
#include "../support/run_length.hpp"
#include "../support/running_program.hpp"
#include "fixtures.hpp"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <thread>
#include <tuple>

#include <sys/resource.h>

#include <penumbra/labels/labels.hpp>

#include <io/cloud/cloud_file.hpp>

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

TEST_F(RunTest, ImagesNamedByTimeBelongToTheRowsOfTheirStamps) {
  succeed(run({"--save", "labels"}));
  std::vector<std::string> wanted;
  for (std::size_t i = 0; i < 3; ++i) wanted.push_back(read_file(out("labels") / numbered(i)));
  write_joints(
      "frame,stamp,slide\n0,1700000000000000000,0.0\n1,1700000000100000000,0.05\n"
      "2,1700000000200000000,0.1\n");
  const Words times{"1700000000.000000", "1700000000.100000", "1700000000.200000"};
  for (std::size_t i = 0; i < 3; ++i) {
    for (const std::string kind : {"depth_", "color_"})
      fs::rename(path(kind + std::to_string(i) + ".png"), path(kind + times[i] + ".png"));
    write("found_" + times[i] + ".txt", "0 0.5 0.5 0.2 0.2 0.9\n");
  }
  succeed(penumbra({"init", path(), "--force"}));
  expect_has(read_file(path("recording.yaml")), {"depth: \"depth_%t.png\""});
  succeed(run({"--save", "labels", "--targets", path("found_%t.txt")}));
  EXPECT_EQ(statuses(), (Words{"ok", "ok", "ok"}));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(read_file(out("labels") / numbered(i)) == wanted[i]) << times[i];
    EXPECT_EQ(report()["frames"][i]["targets"].size(), 1U) << times[i];
  }
  fs::rename(path("depth_" + times[1] + ".png"), path("depth_1700000000.350000.png"));
  succeed(run());
  EXPECT_EQ(statuses(), (Words{"ok", "missing_depth", "ok", "missing_joints"}));
  expect_has(message(3), {"depth_1700000000.350000.png"});
  write_joints("frame,slide\n0,0.0\n1,0.05\n2,0.1\n");
  expect_refused(run(), {"recording.yaml:", "frames.depth: ", "no stamps"});
  expect_has(succeed(penumbra({"init", path(), "--force"})).out, {"depth_%t.png: ", "no stamps"});
}

TEST_F(RunTest, WritesDepthAndPointsWithoutTheRobot) {
  succeed(run({"--save", "labels,filtered,points", "--points-frame", "base"}));
  const auto depth = read_image<std::uint16_t>(path("depth_0.png"));
  const auto filtered = read_image<std::uint16_t>(out("filtered/000000.png"));
  const Image<std::uint8_t> label = labels(0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const bool is_kept = is_trusted(static_cast<Label>(label.data()[i]));
    ASSERT_EQ(filtered.data()[i], is_kept ? depth.data()[i] : 0) << i;
    kept += filtered.data()[i] > 0 ? 1 : 0;
  }
  ASSERT_GT(kept, 0U);
  const auto pcd = io::read_cloud(out("points/000000.pcd"));
  const auto ply = io::read_cloud(out("points/000000.ply"));
  EXPECT_EQ(pcd.cloud.width, kept);
  EXPECT_EQ(ply.cloud.width, kept);
  EXPECT_EQ(std::memcmp(pcd.cloud.data.data(), ply.cloud.data.data(), 3 * sizeof(float)), 0);
}

TEST_F(RunTest, WritesTheReportOfAGoodRecording) {
  EXPECT_EQ(succeed(run()).err, "") << "nothing is said in a pipe where nothing is wrong";
  const Json json = report();
  expect_report(json);
  expect_values(json, {{"/links", {"base", "board"}},
                       {"/renderer/backend", "cpu"},
                       {"/renderer/device", nullptr},
                       {"/summary/bad_frames", 0},
                       {"/summary/missing_links", Json::array()},
                       {"/summary/pixels/front", 192}});
  ASSERT_EQ(json["frames"].size(), 3U);
  for (const Json& frame : json["frames"]) {
    expect_values(frame, {{"/status", "ok"},
                          {"/stamp_ns", nullptr},
                          {"/joint_age_ms", nullptr},
                          {"/pixels/front", 64},    // the object of 8 x 8 pixels
                          {"/pixels/unknown", 32},  // the hole of 4 x 8 pixels
                          {"/pixels/beyond", 0}});
    EXPECT_GT(frame["timing_ms"]["render"], 0.0);
  }
  EXPECT_FALSE(fs::exists(out("labels")));
  succeed(penumbra({"run", path("."), "-o", out()}));
  EXPECT_EQ(report()["input"], fs::canonical(path()).string()) << "a name for the page's title";
}

TEST_F(RunTest, SavesWhatIsAskedFor) {
  succeed(run({"--save", "vdi,labels,links,overlay", "--renderer", "reference"}));
  EXPECT_EQ(report()["renderer"]["backend"], "reference");
  for (std::size_t frame = 0; frame < 3; ++frame) {
    const auto vdi = read_image<float>(out("vdi") / numbered(frame, ".npy"));
    const auto links = read_image<std::uint16_t>(out("links") / numbered(frame));
    const Image<std::uint8_t> image = labels(frame);
    EXPECT_EQ(read_image<Rgb8>(out("overlay") / numbered(frame)).width(), tiny_width);
    for (std::size_t i = 0; i < vdi.size(); ++i) {
      ASSERT_EQ(links.data()[i], vdi.data()[i] > 0.0F ? 2 : 0);
      ASSERT_EQ(image.data()[i] != 0, vdi.data()[i] > 0.0F);
    }
    EXPECT_EQ(image(28, 24), 1);
    EXPECT_EQ(image(38, 24), 3);
    EXPECT_EQ(image(33, 24), 2);
  }
}

TEST_F(RunTest, GoesOnAfterFramesWithoutAPose) {
  using Case = std::tuple<std::string, std::string, Words>;
  for (const auto& [joints, status, named] :
       {Case{"frame,slide\n0,0.0\n1,far\n2,0.1\n", "missing_joints", {"joint_states.csv"}},
        {"frame,slide\n0,0.0\n2,0.1\n", "missing_joints", {"joint_states.csv", "frame 1"}},
        // From slide = -1.05 to -0.95 the board, 0.1 m thick, holds the camera's centre.
        {"frame,slide\n0,0.0\n1,-1.0\n2,0.1\n", "missing_transform", {"'board'"}}}) {
    write_joints(joints);
    const Outcome outcome = succeed(run({"--save", "vdi,labels"}));
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    expect_has(outcome.err, named);
    expect_report(report());
    EXPECT_EQ(statuses(), (Words{"ok", status, "ok"}));
    expect_values(report(), {{"/summary/bad_frames", 1},
                             {"/frames/1/index", 1},
                             {"/frames/1/pixels/robot", nullptr},
                             {"/frames/1/timing_ms/render", nullptr},
                             {"/frames/1/pixels/unknown", tiny_width * tiny_height}});
    EXPECT_FALSE(fs::exists(out("vdi/000001.npy"))) << "there is none without a pose";
    const Image<std::uint8_t> image = labels(1);
    EXPECT_EQ(std::count(image.data(), image.data() + image.size(), 3), tiny_width * tiny_height);
  }
  fs::remove(path("depth_0.png"));
  EXPECT_EQ(count_lines(succeed(run()).err), 2U) << "one line for each kind";
  expect_report(report());
  EXPECT_EQ(statuses(), (Words{"missing_depth", "missing_transform", "ok"}));
  expect_has(message(0), {"depth_0.png"});
  EXPECT_EQ(report()["frames"][0]["pixels"]["unknown"], tiny_width * tiny_height);
  EXPECT_GT(report()["frames"][0]["pixels"]["robot"], 0);

  write_joints("frame,slide\n0,-1.0\n1,-1.0\n2,-1.0\n");
  expect_failed(run(), {"ignore_links"});
  write_joints("frame,slide\n0,0.0\n1,0.05\n");
  expect_has(run().err, {"joint_states.csv", "frame 2"});
  EXPECT_EQ(statuses()[2], "missing_joints");
  EXPECT_EQ(run({"--frames", "1:2"}).err, "") << "the frame is not asked for";
}

TEST_F(RunTest, TakesARangeOfFrames) {
  succeed(run({"--frames", "1:3", "--save", "labels"}));
  const Json json = report();
  ASSERT_EQ(json["frames"].size(), 2U);
  EXPECT_EQ(json["frames"][0]["index"], 1);
  EXPECT_FALSE(fs::exists(out("labels/000000.png")));
  EXPECT_TRUE(fs::exists(out("labels/000002.png")));

  succeed(run({"--frames", ":1", "--save", "labels"}));
  EXPECT_TRUE(fs::exists(out("labels/000000.png")));
  EXPECT_FALSE(fs::exists(out("labels/000002.png"))) << "an earlier run's image";
}

TEST_F(RunTest, StampsAreToldWhereTheyAreKnown) {
  write_joints("frame,stamp,slide\n0,1700000000123456789,0.0\n1,1700000000223456789,0.05\n");
  succeed(run());
  EXPECT_EQ(report()["frames"][0]["stamp_ns"], 1700000000123456789);
  EXPECT_EQ(report()["frames"][0]["joint_age_ms"], 0.0);

  write_joints("frame,stamp,slide\n0,5,0.0\n1,6,far\n");
  succeed(run());
  EXPECT_EQ(report()["frames"][1]["stamp_ns"], 6);
  EXPECT_TRUE(report()["frames"][1]["joint_age_ms"].is_null()) << "of joints that are missing";
}

TEST_F(RunTest, OptionsComeBeforeTheRecordingBeforeTheDefault) {
  const auto front = [&] { return report()["frames"][0]["pixels"]["front"].get<int>(); };
  edit("recording.yaml", "  parent:", "  tolerance: [0.6, 0.0, 0.0]\n  parent:");
  succeed(run());
  EXPECT_EQ(front(), 0) << "the recording's tolerance";
  succeed(run({"--labels", "paper"}));
  EXPECT_EQ(front(), 64);
  succeed(run({"--tolerance", "0.02,0,0"}));
  EXPECT_EQ(front(), 64);
  succeed(run({"--tolerance", "0.02,0,0", "--front-min-width", "9"}));
  EXPECT_EQ(front(), 0) << "the object is 8 pixels wide";
}

TEST_F(RunTest, TheReportSaysByWhichRuleItWasMade) {
  const LabelRule rule;
  edit("recording.yaml", "  parent:",
       "  tolerance: [0.03, 0.0, 0.001]\n  range: [0.25, 4.0]\n  beyond: visible\n  parent:");
  edit("recording.yaml", "  urdf: tiny.urdf",
       "  urdf: tiny.urdf\n  geometry: {board: collision}\n  margins: {board: 0.01}");
  succeed(run({"--image", "rectified"}));
  const Json tolerance = {0.03, 0.0, 0.001}, range = {0.25, 4.0};
  EXPECT_EQ(report()["settings"],
            (Json{{"tolerance", tolerance},
                  {"front_min_width", rule.front_min_width},
                  {"edge_margin", rule.edge_margin},
                  {"fringe_reach", rule.fringe_reach},
                  {"scene_memory", rule.scene_memory},
                  {"beyond_factor", rule.beyond_factor},
                  {"labels", "full"},
                  {"beyond", "visible"},
                  {"targets", nullptr},
                  {"target_history_s", 0.0},
                  {"bag", nullptr},
                  {"range", range},
                  {"image", "rectified"},
                  {"geometry", {{"default", "collision"}, {"links", {{"board", "collision"}}}}},
                  {"geometry_fallback", true},
                  {"margins", {{"board", 0.01}}},
                  {"extra", Json::array()},
                  {"ignore_links", Json::array()},
                  {"joints", Json::object()},
                  {"only_links", Json::array()}}));
  succeed(run({"--labels", "paper"}));
  expect_values(report()["settings"],
                {{"/labels", "paper"}, {"/front_min_width", 0}, {"/image", "raw"}});
}

TEST_F(RunTest, RectifiedImagesHaveTheirOwnSize) {
  edit("camera_info.yaml", "d: [0.0", "d: [-0.2");
  for (const char* image : {"raw", "rectified"}) {
    succeed(run({"--image", image, "--save", "vdi,labels,overlay"}));
    const auto vdi = read_image<float>(out("vdi/000000.npy"));
    EXPECT_EQ(vdi.width() == tiny_width, std::string(image) == "raw");
    EXPECT_EQ(labels(0).width(), vdi.width());
  }
}

using Process = TinyTest;

TEST_F(Process, ARunOnTheRecordingStaysSmall) {
  PENUMBRA_REQUIRE_DATA();
  if (sanitized) GTEST_SKIP() << "skipped: sanitized";
  constexpr double budget = 200.0;  // MB
  succeed(penumbra({"run", data_folder() / "xarm7_realsense", "-o", out(), "--save",
                    "vdi,labels,links,overlay"}));
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const double peak = static_cast<double>(usage.ru_maxrss) / 1024.0;
  std::cout << peak << " MB\n";
  EXPECT_LT(peak, budget);
  EXPECT_GT(peak, 1.0) << "not measured";
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
  edit("recording.yaml", "  color: color_%d.png\n", "");
  RunningProgram program({"run", path(), "-o", out(), "--save", "labels"}, path("log"));
  while (!program.has_ended() && !fs::exists(out("labels/000000.png")))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_EQ(program.end(SIGINT), 130);
  const Json json = report();
  const std::size_t done = json["frames"].size();
  EXPECT_GT(done, 0U);
  EXPECT_LT(done, many_frames);
  EXPECT_EQ(json["summary"]["frames"], done);
  const std::string note = json["summary"]["notes"].back();
  expect_has(note, {"stopped after " + std::to_string(done)});
  expect_has(read_file(path("log")), {note});
  std::size_t images = 0;
  for (const auto& entry : fs::directory_iterator(out("labels")))
    images += entry.path().extension() == ".png" ? 1 : 100'000;  // nothing unfinished
  EXPECT_EQ(images, done);
}

}  // namespace
}  // namespace penumbra::test
