// SPDX-License-Identifier: Apache-2.0
#include "json.hpp"
#include "program.hpp"
#include "tiny_recording.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <io/files/npy.hpp>
#include <io/files/png.hpp>

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

constexpr double depth_tolerance = 1e-5;  // metres at 1 m: float32

class RenderTest : public testing::Test {
 protected:
  RenderTest() { write_tiny_recording(folder_.path()); }

  Outcome render(const std::vector<std::string>& options) {
    std::vector<std::string> line = {"render",
                                     "--robot",
                                     folder_.path() / "tiny.urdf",
                                     "--camera",
                                     folder_.path() / "camera_info.yaml",
                                     "--pose",
                                     folder_.path() / "camera_pose.csv",
                                     "-o",
                                     folder_.path() / "vdi.npy"};
    line.insert(line.end(), options.begin(), options.end());
    return penumbra(line);
  }
  [[nodiscard]] Image<float> vdi() const {
    Image<float> image;
    io::read_npy(folder_.path() / "vdi.npy", image).require();
    return image;
  }
  void expect_refused(const Outcome& outcome, const std::string& word) const {
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "vdi.npy"));
  }

  TemporaryFolder folder_;
};

TEST_F(RenderTest, WritesOneVirtualDepthImage) {
  ASSERT_EQ(render({}).status, 0);
  EXPECT_NEAR(vdi()(31, 23), 0.95, depth_tolerance) << "at rest";
  const Outcome moved = render({"--joint", "slide=0.25", "--links", folder_.path() / "links.png"});
  ASSERT_EQ(moved.status, 0) << moved.err;
  EXPECT_NEAR(vdi()(31, 23), 1.2, depth_tolerance);
  Image<std::uint16_t> links;
  io::read_png(folder_.path() / "links.png", links).require();
  EXPECT_EQ(links(31, 23), 2);
  EXPECT_EQ(links(0, 0), 0);
}

TEST_F(RenderTest, RectifiedImagesAreOfTheCamerasP) {
  const fs::path info = folder_.path() / "camera_info.yaml";
  edit_file(info, "k: [60.0, 0.0, 31.3, 0.0, 60.0", "k: [40.0, 0.0, 31.3, 0.0, 40.0");
  ASSERT_EQ(render({}).status, 0);
  const std::string expected = read_file(folder_.path() / "vdi.npy");

  // The same camera by its p alone, as the driver tells it of a lens with distortion.
  edit_file(info, "k: [40.0, 0.0, 31.3, 0.0, 40.0", "k: [60.0, 0.0, 31.3, 0.0, 60.0");
  edit_file(info, "p: [60.0, 0.0, 31.3, 0.0, 0.0, 60.0", "p: [40.0, 0.0, 31.3, 0.0, 0.0, 40.0");
  edit_file(info, "d: [0.0", "d: [-0.2");
  const Outcome outcome = render({"--rectified"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_file(folder_.path() / "vdi.npy"), expected);
  ASSERT_EQ(render({}).status, 0);
  EXPECT_NE(read_file(folder_.path() / "vdi.npy"), expected) << "k and d";
}

TEST_F(RenderTest, PrintsTimesAndPositionsAsJson) {
  const Outcome outcome = render({"--joint", "slide=0.25", "--repeat", "20", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
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
  expect_refused(render({"--joint", "slid=0.1"}), "slide");
  expect_refused(render({"--joint", "slide"}), "--joint");
  expect_refused(render({"--joint", "slide=far"}), "slide=far");
  expect_refused(render({"--joint", "slide=nan"}), "slide=nan");
  expect_refused(render({"--joint", "slide=1", "--joint", "slide=2"}), "twice");
  expect_refused(render({"--joint", "slide=1e9"}), "'board'");
  expect_refused(render({"--joint", "slide=-1"}), "ignore_links");
  expect_refused(render({"--parent", "bass"}), "bass");
  expect_refused(render({"--links", folder_.path() / "vdi.npy"}), "--links");
  EXPECT_EQ(render({"--joint", "slide=1e9"}).err.find("no depth image"), std::string::npos)
      << "render takes none";
  expect_refused(render({"--repeat", "0"}), "--repeat");
  expect_refused(render({"--package", "name"}), "--package");
  expect_refused(render({"--package", "name=" + (folder_.path() / "nowhere").string()}),
                 "a folder that exists");
  const std::string package = "name=" + folder_.path().string();
  expect_refused(render({"--package", package, "--package", package}), "the only one of name");
}

TEST_F(RenderTest, RefusesAnOutputThatCannotBeWritten) {
  const Outcome outcome = render({"--links", folder_.path() / "nowhere" / "links.png"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_NE(outcome.err.find("nowhere"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "vdi.npy")) << "both or none";
}

TEST_F(RenderTest, RefusesNamesOfOtherFormats) {
  const fs::path picture = folder_.path() / "v.png";
  write_file(picture, "kept");
  for (const char* name : {"v.png", "v", "npy", "v.npy.png"})
    expect_refused(penumbra({"render", "--robot", folder_.path() / "tiny.urdf", "--camera",
                             folder_.path() / "camera_info.yaml", "--pose",
                             folder_.path() / "camera_pose.csv", "-o", folder_.path() / name}),
                   "name a file that ends in .npy");
  EXPECT_EQ(read_file(picture), "kept");
  expect_refused(render({"--links", folder_.path() / "links.npy"}), "ends in .png");
}

TEST_F(RenderTest, TellsNotesOnlyOfWhatItDrew) {
  fs::create_directory(folder_.path() / "boards");
  write_file(folder_.path() / "boards/package.xml", "<package><name>boards</name></package>");
  fs::rename(folder_.path() / "board.stl", folder_.path() / "boards/board.stl");
  edit_file(folder_.path() / "tiny.urdf", "board.stl", "package://boards/board.stl");
  edit_file(folder_.path() / "tiny.urdf", "</robot>",
            "<link name=\"tip\"/><joint name=\"mimic\" type=\"prismatic\"><parent "
            "link=\"board\"/><child link=\"tip\"/><mimic joint=\"slide\"/><limit lower=\"-1\" "
            "upper=\"1\" effort=\"1\" velocity=\"1\"/></joint></robot>");
  const Outcome drawn = render({});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_NE(drawn.err.find("note: package boards: taken from"), std::string::npos) << drawn.err;
  fs::remove(folder_.path() / "vdi.npy");
  expect_refused(render({"--joint", "mimic=0.01"}), "mimic");
  expect_refused(render({"--joint", "slide=1", "--joint", "slide=2"}), "twice");
  expect_refused(render({"--parent", "foo"}), "foo");
  expect_refused(render({"--joint", "slide=-1"}), "ignore_links");
  const auto run = [&] { return penumbra({"run", folder_.path(), "-o", folder_.path() / "out"}); };
  EXPECT_NE(run().err.find("note: package boards: taken from"), std::string::npos) << run().err;
  edit_file(folder_.path() / "camera_info.yaml", "width: 64\nheight: 48", "width: 48\nheight: 64");
  const Outcome ran = run();
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(count_lines(ran.err), 1U) << ran.err;
}

TEST_F(RenderTest, RefusesEmptyNamesAndFolders) {
  expect_refused(render({"--links", ""}), "--links: '' is not a path");
  fs::create_directory(folder_.path() / "links.png");
  expect_refused(render({"--links", folder_.path() / "links.png"}), "is a folder");
}

TEST_F(RenderTest, FormerImagesStayWhereTheCallFails) {
  const fs::path vdi = folder_.path() / "vdi.npy", links = folder_.path() / "links.png";
  write_file(vdi, "measured");
  write_file(links, "drawn");
  const auto expect_left = [&](const std::vector<std::string>& options) {
    const Outcome outcome = render(options);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find("vdi.npy is left as it was"), std::string::npos) << outcome.err;
    EXPECT_EQ(read_file(vdi), "measured");
    EXPECT_EQ(read_file(links), "drawn");
  };
  expect_left({"--joint", "slid=0.1"});
  expect_left({"--joint", "slide=-1", "--links", links});
  expect_left({"--links", folder_.path() / "nowhere/links.png"});
  fs::rename(folder_.path() / "board.stl", folder_.path() / "board.away");
  expect_left({"--links", links});
  fs::rename(folder_.path() / "board.away", folder_.path() / "board.stl");
  EXPECT_EQ(render({"--links", links}).status, 0);
  EXPECT_NE(read_file(vdi), "measured");
  EXPECT_NE(read_file(links), "drawn");
}

TEST_F(RenderTest, TheInputIsNoOutput) {
  const std::string pose = read_file(folder_.path() / "camera_pose.csv");
  expect_refused(render({"--links", folder_.path() / "." / "camera_pose.csv"}), "--pose");
  EXPECT_EQ(read_file(folder_.path() / "camera_pose.csv"), pose);
}

class InspectTest : public RenderTest {
 protected:
  Outcome inspect(const std::vector<std::string>& options = {}) {
    std::vector<std::string> line = {"inspect", folder_.path() / "tiny.urdf"};
    line.insert(line.end(), options.begin(), options.end());
    return penumbra(line);
  }
};

TEST_F(InspectTest, TellsLinksAndJoints) {
  const Outcome outcome = inspect();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* word : {"tiny", "board", "board.stl", "12", "0.400 x 0.200 x 0.100", "slide",
                           "prismatic", "-1.0000 .. 1.0000"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << " is not in\n" << outcome.out;
}

TEST_F(InspectTest, TellsTheSameAsJson) {
  const Outcome outcome = inspect({"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["robot"], "tiny");
  EXPECT_EQ(json["links"][0]["drawn"], false);
  EXPECT_EQ(json["links"][1]["triangles"], 12);
  EXPECT_EQ(json["links"][1]["watertight"], true);
  EXPECT_EQ(json["joints"][0]["upper"], 1.0);
  EXPECT_TRUE(json["joints"][0]["mimic"].is_null());
  EXPECT_EQ(json["variables"], Json{"slide"});
}

TEST_F(InspectTest, TellsWhereItsOutputCannotBeWritten) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string line = std::string(PENUMBRA_PROGRAM) + " inspect " +
                           (folder_.path() / "tiny.urdf").string() + " > /dev/full 2> " +
                           (folder_.path() / "err").string();
  const int result = std::system(line.c_str());
  EXPECT_EQ(WEXITSTATUS(result), 2);
  EXPECT_EQ(read_file(folder_.path() / "err"), "penumbra: standard output: cannot be written\n");
}

TEST_F(InspectTest, ShowsTheOthersWhereAMeshIsMissing) {
  fs::remove(folder_.path() / "board.stl");
  const Outcome outcome = inspect();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_EQ(outcome.err, render({}).err) << "with the line, too";
  EXPECT_NE(outcome.out.find("MISSING"), std::string::npos) << outcome.out;
  const std::size_t named = outcome.out.find("board.stl");
  ASSERT_NE(named, std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("board.stl", named + 1), std::string::npos) << outcome.out;
}

TEST_F(InspectTest, PathsNeverSteerTheTerminal) {
  edit_file(folder_.path() / "tiny.urdf", "board.stl", "\x1b[31m\u009b31mred.stl");
  const Outcome outcome = inspect({"--allow-missing-meshes"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("\u009b"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("?[31m?31mred.stl"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace penumbra::test
