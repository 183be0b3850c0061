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
    write_file(path("joint_states.csv"), "frame,stamp,slide\n0,0,0.0\n1,100000000,0.05\n");
    write_file(path("late.csv"), "frame,stamp,slide\n0,20000000,0.0\n1,520000000,0.05\n");
    write_file(path("targets.yaml"),
               "targets:\n  - name: part\n    point: [-0.05, 0.0, 0.5]\n    radius: 0.03\n"
               "    link: base\n    depth_margin: 0.05\n");
    write_file(path("behind.yaml"),
               "targets:\n  - name: part\n    point: [0.1, 0.0, 1.5]\n    radius: 0.03\n"
               "    link: base\n");
  }
  void write_yaml(const std::string& of_right) const {
    const std::string camera =
        "    info: camera_info.yaml\n    parent: base\n    pose: camera_pose.csv\n"
        "    depth: depth_%d.png\n    color: color_%d.png\n";
    write_file(path("recording.yaml"), "robot:\n  urdf: tiny.urdf\ncameras:\n  left:\n" + camera +
                                           "  right:\n" + camera + of_right +
                                           "frames:\n  joints: joint_states.csv\n"
                                           "targets: targets.yaml\n");
  }
  [[nodiscard]] Json views() const { return Json::parse(read_file(out() / "views.json")); }
};

/// A report without what differs from run to run.
Json without_times(Json report) {
  report["summary"].erase("timing_ms");
  for (Json& frame : report["frames"]) frame.erase("timing_ms");
  return report;
}

TEST_F(CamerasTest, EachCameraGetsTheResultsOfItsOwnRun) {
  const Outcome outcome = run({"--save", "labels"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_has(outcome.out, {"camera left:", "camera right:", "over 2 cameras", "views.json"});
  const fs::path alone = path("alone");
  ASSERT_EQ(penumbra({"run", path(), "-o", alone, "--camera", "right", "--save", "labels"}).status,
            0);
  EXPECT_EQ(without_times(Json::parse(read_file(out() / "right" / "report.json"))),
            without_times(Json::parse(read_file(alone / "report.json"))));
  EXPECT_EQ(read_file(out() / "right" / "labels" / "000001.png"),
            read_file(alone / "labels" / "000001.png"));
  EXPECT_FALSE(fs::exists(alone / "views.json"));
  EXPECT_EQ(run().status, 0) << "a second run replaces the first";
}

TEST_F(CamerasTest, TheNumberOfThreadsChangesNothing) {
  ASSERT_EQ(run({"--threads", "1"}).status, 0);
  const std::string one = read_file(out() / "views.json");
  ASSERT_EQ(run({"--threads", "4"}).status, 0);
  EXPECT_EQ(read_file(out() / "views.json"), one);
}

TEST_F(CamerasTest, HiddenInOneCameraAndSeenInAnotherIsVisible) {
  write_yaml("    targets: behind.yaml\n");
  ASSERT_EQ(run().status, 0);
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
  EXPECT_EQ(target["views"][0]["verdict"], "visible") << target.dump();
  EXPECT_EQ(target["views"][1]["verdict"], "hidden");
  EXPECT_EQ(target["verdict"], "visible");
  EXPECT_EQ(target["best"], "left");
  EXPECT_EQ(target["covariance"].size(), 9U);
  ASSERT_EQ(target["point"].size(), 3U);
  constexpr double radius = 0.03, rounding = 0.001;  // metres; of whole pixels
  EXPECT_NEAR(target["point"][2], 0.5 + radius / 2, rounding) << "behind the depth image's";
}

TEST_F(CamerasTest, TheReportHasAllCameras) {
  write_yaml("    targets: behind.yaml\n");
  ASSERT_EQ(run({"--report"}).status, 0);
  EXPECT_EQ(page_json(read_file(out() / "report.html"), "penumbra-report"), views());
  EXPECT_TRUE(fs::exists(out() / "right" / "report.html"));
}

TEST_F(CamerasTest, AFormerRunStaysUntilAllInputsAreOpen) {
  ASSERT_EQ(run({"--report"}).status, 0);
  write_yaml("    targets: none.yaml\n");
  EXPECT_NE(run().status, 0);
  for (const char* const file : {"views.json", "report.html", "left/report.json"})
    EXPECT_TRUE(fs::exists(out() / file)) << file;
  write_yaml("");
  fs::remove_all(out() / "right" / "labels");
  fs::create_directories(out() / "right" / "labels" / "000000.png" / "in the way");
  EXPECT_NE(run({"--force", "--save", "labels"}).status, 0);
  for (const char* const file : {"views.json", "report.html", "right/report.json"})
    EXPECT_FALSE(fs::exists(out() / file)) << file;
}

TEST_F(CamerasTest, FilesOfTheUserStay) {
  fs::create_directory(out());
  for (const char* const file : {"views.json", "report.html"}) {
    write_file(out() / file, "mine");
    expect_refused(run({"--report"}), {"--force"});
    expect_refused(run({"--frames", "5:4"}), {"out"});
    EXPECT_EQ(read_file(out() / file), "mine");
    fs::remove(out() / file);
  }
}

TEST_F(CamerasTest, ASecondRunIntoTheFolderIsRefused) {
  ASSERT_EQ(run({"--save", "labels"}).status, 0);
  for (const fs::path& folder : {out(), out() / "left"}) {
    const io::FileLock lock(folder);
    expect_refused(run({"--save", "labels"}), {"another program is writing it"});
    EXPECT_TRUE(fs::exists(out() / "left" / "labels" / "000000.png"));
    EXPECT_TRUE(fs::exists(out() / "views.json"));
  }
}

TEST_F(CamerasTest, NamesAreFoldersAndPlainText) {
  const std::string whole = read_file(path("recording.yaml"));
  for (const char* const name : {"views.json", "..", "a/b", "\"a\\e[31mb\"", "\"\""}) {
    write_file(path("recording.yaml"), whole);
    edit_file(path("recording.yaml"), "left:", std::string(name) + ":");
    expect_refused(run(), {"recording.yaml", "name"});
  }
  write_file(path("recording.yaml"), whole);
  edit_file(path("recording.yaml"),
            "left:", R"("x\" autofocus onfocus=\"document.title='run'\" y=\"":)");
  ASSERT_EQ(run({"--report"}).status, 0);
  const std::string page = read_file(out() / "report.html");
  EXPECT_EQ(page.find("autofocus onfocus=\""), std::string::npos);
  EXPECT_EQ(page_json(page, "penumbra-report"), views());
}

TEST_F(CamerasTest, ViewServesNoOtherFolder) {
  ASSERT_EQ(run().status, 0);
  fs::rename(out() / "right", path("elsewhere"));
  fs::create_directory_symlink(path("elsewhere"), out() / "right");
  expect_refused(penumbra({"view", out(), "--port", "0"}), {"right", "link"});
  for (const fs::path& name : {fs::path("../elsewhere"), path("elsewhere")}) {
    write_file(out() / "views.json", "{\"cameras\": [\"left\", \"" + name.string() + "\"]}");
    expect_refused(penumbra({"view", out(), "--port", "0"}), {"name"});
  }
}

TEST_F(CamerasTest, ViewRefusesWhatIsNotWhole) {
  ASSERT_EQ(run().status, 0);
  fs::remove_all(out() / "right");
  expect_refused(penumbra({"view", out(), "--port", "0"}), {"right"});
  write_file(out() / "views.json", "{");
  expect_refused(penumbra({"view", out(), "--port", "0"}), {"views.json"});
}

TEST_F(CamerasTest, EachImageIsJudgedAtItsOwnStamp) {
  write_yaml("    joints: late.csv\n");
  ASSERT_EQ(run().status, 0);
  const Json json = views();
  std::vector<std::int64_t> stamps;
  for (const Json& frame : json["frames"]) stamps.push_back(frame["stamp_ns"]);
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{0, 20000000, 100000000, 520000000}));
  const auto right = [&](int frame) { return json["frames"][frame]["targets"][0]["views"][1]; };
  EXPECT_TRUE(right(0)["stamp_ns"].is_null()) << "it has no image yet";
  EXPECT_EQ(right(0)["verdict"], "unknown");
  EXPECT_EQ(right(2)["stamp_ns"], 20000000);
  EXPECT_EQ(json["frames"][3]["targets"][0]["views"][0]["verdict"], "unknown")
      << "the left camera's last image is 0.42 s old";
}

TEST_F(CamerasTest, BadInputIsOneLine) {
  expect_refused(run({"--camera", "middle"}), {"recording.yaml", "middle", "left, right"});
  expect_refused(penumbra({"tune", path(), "-o", out()}), {"--camera", "left, right"});
  expect_refused(penumbra({"run", path(), "-o", path("out.mcap")}), {"--camera"});
  write_file(path("joint_states.csv"), "frame,slide\n0,0.0\n1,0.05\n");
  expect_refused(run(), {"left", "stamp", "--fps"});
  EXPECT_EQ(run({"--fps", "10"}).status, 0);
  fs::remove_all(out());
  write_file(path("joint_states.csv"), "frame,stamp,slide\n0,0,0.0\n1,100000000,0.05\n");
  write_yaml("    depht: other.png\n");
  expect_refused(run(), {"recording.yaml", "depht"});
  write_yaml("  ../up:\n    info: camera_info.yaml\n");
  expect_refused(run(), {"recording.yaml", "../up"});
  fs::remove_all(out());
  write_tiny_recording(path());
  expect_refused(run({"--camera", "left"}), {"recording.yaml", "left"});
}

}  // namespace
}  // namespace penumbra::test
