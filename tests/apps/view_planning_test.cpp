// SPDX-License-Identifier: Apache-2.0
// penumbra view-planning on the tiny recording, on the shipped example, and on what it must refuse.
#include "../support/page_json.hpp"
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

constexpr const char* header = "name,x,y,z,qx,qy,qz,qw\n";
constexpr const char* hole = "- {name: hole, point: [0, 0, 2], radius: 0.05, link: base}\n";

class ViewPlanningTest : public TinyTest {
 protected:
  ViewPlanningTest() {
    write_targets(hole);
    // Behind the board; past its side; turned away.
    write_file(path("poses.csv"), std::string(header) +
                                      "ahead,0,0,0,0,0,0,1\n"
                                      "beside,1,0,0,0,0,0,1\n"
                                      "away,0,0,0,0,1,0,0\n");
  }

  Outcome plan(const Words& options = {}) const {
    return penumbra(Words{"view-planning", path(), "-o", out(), "--targets", path("targets.yaml"),
                          "--candidates", path("poses.csv")} +
                    options);
  }
  [[nodiscard]] Json planned() const { return read_json(out("view_planning.json")); }
};

TEST_F(ViewPlanningTest, TellsWhatEachCandidateSeesAndTheBestSet) {
  const Outcome outcome = succeed(plan({"--cameras", "2", "--threads", "2"}));
  EXPECT_EQ(outcome.err, "");
  expect_has(outcome.out, {"candidate", "beside", "100.0 %", "ahead + beside", "per second"});
  expect_values(planned(), {{"/frames", {0, 1, 2}},
                            {"/frames_left_out", 0},
                            {"/candidates/0/name", "ahead"},
                            {"/candidates/0/targets/0/by_frame", "hhh"},
                            {"/candidates/0/targets/0/hidden", 1.0},
                            {"/candidates/1/name", "beside"},
                            {"/candidates/1/targets/0/by_frame", "vvv"},
                            {"/candidates/2/name", "away"},
                            {"/candidates/2/targets/0/by_frame", "ooo"},
                            {"/best/0/cameras", Json{"beside"}},
                            {"/best/1/visible/hole", 1.0}});
  EXPECT_EQ(page_json(read_file(out("report.html")), "penumbra-report"), planned());
}

TEST_F(ViewPlanningTest, TakesAttachedBodiesAndFramesWithoutDepth) {
  write_file(path("depth_0.png"), "no picture");
  edit_file(path("recording.yaml"), "frames:",
            "attached:\n  - {name: part, link: board, box: [3, 3, 0.1], pose: [0, 0, 0.5, 0, 0, 0, "
            "1], frames: [1, 2]}\nframes:");
  succeed(plan());
  EXPECT_EQ(planned()["candidates"][1]["targets"][0]["by_frame"], "vhv");
}

TEST_F(ViewPlanningTest, PlacesTargetsOfTheCamerasFrameByTheRecordedCamera) {
  write_targets("- {name: hole, point: [0, 0, 2], radius: 0.05}\n");
  succeed(plan());  // the recorded camera is at the base
  EXPECT_EQ(planned()["candidates"][1]["targets"][0]["by_frame"], "vvv");
  EXPECT_EQ(planned()["candidates"][2]["targets"][0]["by_frame"], "ooo");
}

TEST_F(ViewPlanningTest, LeavesOutFramesWithoutAPose) {
  edit_file(path("joint_states.csv"), "\n1,", "\n7,");
  expect_has(succeed(plan()).err, {"are left out", "no row for frame 1"});
  EXPECT_EQ(planned()["frames_left_out"], 1);
}

TEST_F(ViewPlanningTest, RunsOnTheExample) {
  const fs::path inputs = example / "../view_planning";
  succeed(penumbra({"view-planning", example, "--targets", inputs / "targets.yaml", "--candidates",
                    inputs / "candidates.csv", "--cameras", "2", "-o", out()}));
  EXPECT_EQ(planned()["best"][1]["mean_visible"], 1.0);
  EXPECT_LT(planned()["best"][0]["mean_visible"], 1.0);
}

TEST_F(ViewPlanningTest, RefusesWithOneLine) {
  struct Bad {
    std::string poses, targets;
    Words options, named;
  };
  const std::string one = std::string(header) + "a,0,0,0,0,0,0,1\n";
  const std::vector<Bad> all = {
      {"", hole, {}, {"poses.csv", "is empty"}},
      {header, hole, {}, {"poses.csv", "no candidate"}},
      {one + "a,1,0,0,0,0,0,1\n", hole, {}, {"poses.csv:3", "'a'", "line 2"}},
      {one + ",1,0,0,0,0,0,1\n", hole, {}, {"poses.csv:3", "name"}},
      {one + "b,nan,0,0,0,0,0,1\n", hole, {}, {"poses.csv:3", "x is 'nan'"}},
      {one + "b,1,0,0,0,0,0,2\n", hole, {}, {"poses.csv:3", "quaternion"}},
      {one + "b,1e7,0,0,0,0,0,1\n", hole, {}, {"poses.csv:3", "1000 km"}},
      {one + "b,1,0\n", hole, {}, {"poses.csv:3", "3 cells"}},
      {"name,x,y,z\na,0,0,0\n", hole, {}, {"poses.csv:1", "'name,x,y,z'", "qx,qy,qz,qw"}},
      {"name,x,y,z,qx,qy,qz,qw,link\na,0,0,0,0,0,0,1,bord\n",
       hole,
       {},
       {"poses.csv:2", "'bord'", "board"}},
      {one, "- {name: cup, box: [1, 1, 9, 9]}\n", {}, {"targets.yaml", "'cup'", "pixels"}},
      {one, "  []\n", {}, {"targets.yaml", "no targets"}},
      {one, hole, {"--cameras", "2"}, {"--cameras", "poses.csv", "candidates, 1"}},
      {one, hole, {"--cameras", "0"}, {"--cameras"}},
      {one, hole, {"--target-topic", "/found"}, {"--target-topic"}},
      {one, hole, {"--threads", "0"}, {"--threads"}}};
  for (const Bad& bad : all) {
    write_file(path("poses.csv"), bad.poses);
    write_targets(bad.targets);
    expect_refused(plan(bad.options), bad.named);
  }
  const std::string poses = path("poses.csv"), targets = path("targets.yaml");
  write_file(poses, one);
  expect_refused(penumbra({"view-planning", path(), "--candidates", poses}), {"--targets"});
  expect_refused(penumbra({"view-planning", path(), "--targets", targets}), {"--candidates"});
  expect_refused(
      penumbra({"view-planning", path(), "--candidates", path("none.csv"), "--targets", targets}),
      {"none.csv"});
}

}  // namespace
}  // namespace penumbra::test
