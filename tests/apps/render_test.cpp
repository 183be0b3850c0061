// SPDX-License-Identifier: Apache-2.0
#include "fixtures.hpp"

#include <cstdlib>

#include <sys/wait.h>

namespace penumbra::test {
namespace {

constexpr double depth_tolerance = 1e-5;  // metres at 1 m: float32

using RenderTest = TinyTest;

TEST_F(RenderTest, WritesOneVirtualDepthImage) {
  succeed(render());
  EXPECT_NEAR(read_image<float>(path("vdi.npy"))(31, 23), 0.95, depth_tolerance) << "at rest";
  succeed(render({"--joint", "slide=0.25", "--links", path("links.png")}));
  EXPECT_NEAR(read_image<float>(path("vdi.npy"))(31, 23), 1.2, depth_tolerance);
  const auto links = read_image<std::uint16_t>(path("links.png"));
  EXPECT_EQ(links(31, 23), 2);
  EXPECT_EQ(links(0, 0), 0);
}

TEST_F(RenderTest, PrintsTimesAndPositionsAsJson) {
  const Json json =
      Json::parse(succeed(render({"--joint", "slide=0.25", "--repeat", "20", "--json"})).out);
  EXPECT_EQ(json["triangles"], 12);
  EXPECT_GT(json["robot_pixels"], 100);
  EXPECT_EQ(json["joints"]["slide"], 0.25);
  for (const char* stage : {"kinematics_ms", "render_ms", "classify_ms"}) {
    EXPECT_GT(json[stage]["min"], 0.0) << stage;
    EXPECT_GE(json[stage]["median"], json[stage]["min"]) << stage;
    EXPECT_GE(json[stage]["p99"], json[stage]["median"]) << stage;
  }
}

TEST_F(RenderTest, RefusesBadInput) {
  fs::create_directory(path("folder.png"));
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--joint", "slid=0.1"}, "slide"},
      {{"--joint", "slide"}, "--joint"},
      {{"--joint", "slide=far"}, "slide=far"},
      {{"--joint", "slide=nan"}, "slide=nan"},
      {{"--joint", "slide=1", "--joint", "slide=2"}, "twice"},
      {{"--joint", "slide=1e9"}, "'board'"},
      {{"--joint", "slide=-1"}, "ignore_links"},
      {{"--parent", "bass"}, "bass"},
      {{"--repeat", "0"}, "--repeat"},
      {{"--package", "name"}, "--package"},
      {{"--links", path("vdi.npy")}, "--links"},
      {{"--links", path("links.npy")}, ".png"},
      {{"--links", path("folder.png")}, "is a folder"},
      {{"--links", ""}, "--links"},
      {{"--links", path(".") / "camera_pose.csv"}, "--pose"}};
  const std::string pose = read_file(path("camera_pose.csv"));
  for (const auto& [options, named] : cases) {
    expect_refused(render(options), {named});
    EXPECT_FALSE(fs::exists(path("vdi.npy")));
  }
  EXPECT_EQ(read_file(path("camera_pose.csv")), pose);
}

TEST_F(RenderTest, FormerImagesStayWhereTheCallFails) {
  const fs::path vdi = path("vdi.npy"), links = path("links.png");
  write_file(vdi, "measured");
  write_file(links, "drawn");
  const auto expect_left = [&](const Words& options) {
    EXPECT_EQ(render(options).status, 2);
    EXPECT_EQ(read_file(vdi), "measured");
    EXPECT_EQ(read_file(links), "drawn");
  };
  expect_left({"--joint", "slide=-1", "--links", links});
  expect_left({"--links", path("nowhere/links.png")});
  fs::rename(path("board.stl"), path("board.away"));
  expect_left({"--links", links});
  fs::rename(path("board.away"), path("board.stl"));
  succeed(render({"--links", links}));
  EXPECT_NE(read_file(vdi), "measured");
  EXPECT_NE(read_file(links), "drawn");
}

using InspectTest = RenderTest;

TEST_F(InspectTest, TellsTheSameAsJson) {
  expect_values(Json::parse(succeed(inspect({"--json"})).out), {{"/robot", "tiny"},
                                                                {"/links/0/drawn", false},
                                                                {"/links/1/triangles", 12},
                                                                {"/links/1/watertight", true},
                                                                {"/joints/0/upper", 1.0},
                                                                {"/joints/0/mimic", nullptr},
                                                                {"/variables", Json{"slide"}}});
}

TEST_F(InspectTest, TellsWhereItsOutputCannotBeWritten) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string line = std::string(PENUMBRA_PROGRAM) + " inspect " +
                           path("tiny.urdf").string() + " > /dev/full 2> " + path("err").string();
  const int result = std::system(line.c_str());
  EXPECT_EQ(WEXITSTATUS(result), 2);
  EXPECT_EQ(read_file(path("err")), "penumbra: standard output: cannot be written\n");
}

TEST_F(InspectTest, ShowsTheOthersWhereAMeshIsMissing) {
  fs::remove(path("board.stl"));
  const Outcome outcome = inspect();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_EQ(outcome.err, render().err) << "with the line, too";
  expect_has(outcome.out, {"MISSING"});
  const std::size_t named = outcome.out.find("board.stl");
  ASSERT_NE(named, std::string::npos) << outcome.out;
  expect_lacks(outcome.out.substr(named + 1), {"board.stl"});
}

TEST_F(InspectTest, PathsNeverSteerTheTerminal) {
  edit_file(path("tiny.urdf"), "board.stl", "\x1b[31m\u009b31mred.stl");
  const std::string text = succeed(inspect({"--allow-missing-meshes"})).out;
  expect_lacks(text, {"\x1b", "\u009b"});
  expect_has(text, {"?[31m?31mred.stl"});
}

}  // namespace
}  // namespace penumbra::test
