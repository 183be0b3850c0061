// SPDX-License-Identifier: Apache-2.0
// Recordings with several cameras: each alone, and all of them.
#include "../support/page_json.hpp"
#include "fixtures.hpp"

#include <io/files/pending_file.hpp>

namespace penumbra::test {
namespace {

/// Two cameras at one place with one set of images; the board is a target at x = 0.1.
class CamerasTest : public TinyTest {
 protected:
  CamerasTest() {
    write_yaml("");
    write_joints("frame,stamp,slide\n0,0,0.0\n1,100000000,0.05\n");
    write("late.csv", "frame,stamp,slide\n0,20000000,0.0\n1,520000000,0.05\n");
    write_targets(
        "- {name: part, point: [-0.05, 0, 0.5], radius: 0.03, link: base, depth_margin: 0.05}\n");
    write("behind.yaml",
          "targets: [{name: part, point: [0.1, 0, 1.5], radius: 0.03, link: base}]\n");
  }
  void write_yaml(const std::string& of_right) const {
    write("recording.yaml", two_cameras_yaml(of_right, "targets: targets.yaml\n"));
  }
  [[nodiscard]] Json views() const { return read_json(out("views.json")); }
};

TEST_F(CamerasTest, EachCameraGetsTheResultsOfItsOwnRun) {
  expect_has(succeed(run({"--save", "labels"})).out,
             {"camera left:", "camera right:", "over 2 cameras", "views.json"});
  const fs::path alone = path("alone");
  succeed(penumbra({"run", path(), "-o", alone, "--camera", "right", "--save", "labels"}));
  EXPECT_EQ(without_times(out("right/report.json")), without_times(alone / "report.json"));
  EXPECT_EQ(read_file(out("right/labels/000001.png")), read_file(alone / "labels/000001.png"));
  EXPECT_FALSE(fs::exists(alone / "views.json"));
}

TEST_F(CamerasTest, HiddenInOneCameraAndSeenInAnotherIsVisible) {
  write_yaml("    targets: behind.yaml\n");
  succeed(run({"--report"}));
  const Json json = views();
  EXPECT_EQ(keys(json), (Words{"penumbra", "input", "cameras", "frames"}));
  EXPECT_EQ(json["cameras"], (Json{"left", "right"}));
  ASSERT_EQ(json["frames"].size(), 2U);
  const Json& target = json["frames"][0]["targets"][0];
  EXPECT_EQ(keys(target), (Words{"name", "verdict", "reason", "best", "point", "covariance",
                                 "contradiction", "views"}));
  EXPECT_EQ(keys(target["views"][0]),
            (Words{"camera", "stamp_ns", "verdict", "reason", "visible_fraction", "point",
                   "distance_m", "angle_rad"}));
  expect_values(target, {{"/views/0/verdict", "visible"},
                         {"/views/1/verdict", "hidden"},
                         {"/verdict", "visible"},
                         {"/best", "left"}});
  EXPECT_EQ(target["covariance"].size(), 9U);
  ASSERT_EQ(target["point"].size(), 3U);
  constexpr double radius = 0.03, rounding = 0.001;  // metres; of whole pixels
  EXPECT_NEAR(target["point"][2], 0.5 + radius / 2, rounding) << "behind the depth image's";

  EXPECT_EQ(page_json(read_file(out("report.html")), "penumbra-report"), json);
  EXPECT_TRUE(fs::exists(out("right/report.html")));
}

TEST_F(CamerasTest, FilesOfTheUserStay) {
  fs::create_directory(out());
  for (const char* const file : {"views.json", "report.html"}) {
    write_file(out(file), "mine");
    expect_refused(run({"--report"}), {"--force"});
    expect_refused(run({"--frames", "5:4"}), {"out"});
    EXPECT_EQ(read_file(out(file)), "mine");
    fs::remove(out(file));
  }
}

TEST_F(CamerasTest, ASecondRunIntoTheFolderIsRefused) {
  succeed(run({"--save", "labels"}));
  for (const fs::path& folder : {out(), out("left")}) {
    const io::FileLock lock(folder);
    expect_refused(run({"--save", "labels"}), {"another program is writing it"});
    EXPECT_TRUE(fs::exists(out("left/labels/000000.png")));
    EXPECT_TRUE(fs::exists(out("views.json")));
  }
}

TEST_F(CamerasTest, NamesMustBeThoseOfFolders) {
  const std::string whole = read_file(path("recording.yaml"));
  for (const char* const name : {"views.json", "..", "a/b", "\"a\\e[31mb\"", "\"\""}) {
    write("recording.yaml", whole);
    edit("recording.yaml", "left:", std::string(name) + ":");
    expect_refused(run(), {"recording.yaml", "name"});
  }
}

TEST_F(CamerasTest, ViewServesNoOtherFolder) {
  succeed(run());
  const auto expect_no_view = [&](const std::string& named) {
    expect_refused(penumbra({"view", out(), "--port", "0"}), {named});
  };
  fs::rename(out("right"), path("elsewhere"));
  expect_no_view("right");
  write_file(out("views.json"), R"({"cameras": ["left", "../elsewhere"]})");
  expect_no_view("name");
}

TEST_F(CamerasTest, EachImageIsJudgedAtItsOwnStamp) {
  write_yaml("    joints: late.csv\n");
  succeed(run());
  const Json json = views();
  std::vector<std::int64_t> stamps;
  for (const Json& frame : json["frames"]) stamps.push_back(frame["stamp_ns"]);
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{0, 20000000, 100000000, 520000000}));
  expect_values(json, {{"/frames/0/targets/0/views/1/stamp_ns", nullptr},  // it has no image yet
                       {"/frames/0/targets/0/views/1/verdict", "unknown"},
                       {"/frames/2/targets/0/views/1/stamp_ns", 20000000},
                       // The left camera's last image is 0.42 s old.
                       {"/frames/3/targets/0/views/0/verdict", "unknown"}});
}

TEST_F(CamerasTest, BadInputIsOneLine) {
  expect_refused(run({"--camera", "middle"}), {"recording.yaml", "middle", "left, right"});
  expect_refused(penumbra({"tune", path(), "-o", out()}), {"--camera", "left, right"});
  expect_refused(penumbra({"run", path(), "-o", path("out.mcap")}), {"--camera"});
  write_joints("frame,slide\n0,0.0\n1,0.05\n");
  expect_refused(run(), {"left", "stamp", "--fps"});
  succeed(run({"--fps", "10"}));
  fs::remove_all(out());
  write_tiny_recording(path());
  expect_refused(run({"--camera", "left"}), {"recording.yaml", "left"});
}

}  // namespace
}  // namespace penumbra::test
