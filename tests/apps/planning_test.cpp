// SPDX-License-Identifier: Apache-2.0
// penumbra view-planning and look-ahead on the tiny recording, whose board moves along the optical
// axis, and what they must refuse.
#include "../support/page_json.hpp"
#include "fixtures.hpp"

#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

constexpr const char* header = "name,x,y,z,qx,qy,qz,qw\n";
constexpr const char* hole = "- {name: hole, point: [0, 0, 2], radius: 0.05, link: base}\n";

class ViewPlanningTest : public TinyTest {
 protected:
  ViewPlanningTest() {
    write_targets(hole);
    // Behind the board; past its side; turned away.
    write("poses.csv", std::string(header) +
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
  write("depth_0.png", "no picture");
  edit("recording.yaml", "frames:",
       "attached:\n  - {name: part, link: board, box: [3, 3, 0.1], pose: [0, 0, 0.5, 0, 0, 0, "
       "1], frames: [1, 2]}\nframes:");
  succeed(plan());
  EXPECT_EQ(planned()["candidates"][1]["targets"][0]["by_frame"], "vhv");
}

TEST_F(ViewPlanningTest, PlacesTargetsOfTheCamerasFrameAndLeavesOutFramesWithoutAPose) {
  write_targets("- {name: hole, point: [0, 0, 2], radius: 0.05}\n");
  edit("joint_states.csv", "\n1,", "\n7,");
  expect_has(succeed(plan()).err, {"are left out", "no row for frame 1"});
  expect_values(planned(),
                {{"/frames_left_out", 1},
                 {"/candidates/1/targets/0/by_frame", "vvv"},  // the camera is at the base
                 {"/candidates/2/targets/0/by_frame", "ooo"}});
}

TEST_F(ViewPlanningTest, RefusesWithOneLine) {
  const std::string one = std::string(header) + "a,0,0,0,0,0,0,1\n";
  const std::vector<std::pair<std::string, Words>> all = {
      {"", {"poses.csv", "is empty"}},
      {header, {"poses.csv", "no candidate"}},
      {one + "a,1,0,0,0,0,0,1\n", {"poses.csv:3", "'a'", "line 2"}},
      {one + ",1,0,0,0,0,0,1\n", {"poses.csv:3", "name"}},
      {one + "b,nan,0,0,0,0,0,1\n", {"poses.csv:3", "x is 'nan'"}},
      {one + "b,1,0,0,0,0,0,2\n", {"poses.csv:3", "quaternion"}},
      {one + "b,1e7,0,0,0,0,0,1\n", {"poses.csv:3", "millimetres"}},
      {one + "b,1,0\n", {"poses.csv:3", "3 cells"}},
      {"name,x,y,z\na,0,0,0\n", {"poses.csv:1", "'name,x,y,z'", "qx,qy,qz,qw"}},
      {"name,x,y,z,qx,qy,qz,qw,link\na,0,0,0,0,0,0,1,bord\n", {"poses.csv:2", "'bord'", "board"}}};
  for (const auto& [candidates, named] : all) {
    write("poses.csv", candidates);
    expect_refused(plan(), named);
  }
  write("poses.csv", one);
  expect_all_refused([&](const Words& options) { return plan(options); },
                     {{{"--cameras", "2"}, "candidates, 1"},
                      {{"--cameras", "0"}, "--cameras"},
                      {{"--target-topic", "/found"}, "--target-topic"},
                      {{"--threads", "0"}, "--threads"}});
  const std::string poses = path("poses.csv"), targets = path("targets.yaml");
  expect_refused(penumbra({"view-planning", path(), "--candidates", poses}), {"--targets"});
  expect_refused(penumbra({"view-planning", path(), "--targets", targets}), {"--candidates"});
  expect_refused(
      penumbra({"view-planning", path(), "--candidates", path("none.csv"), "--targets", targets}),
      {"none.csv"});
  write_targets("- {name: cup, box: [1, 1, 9, 9]}\n");
  expect_refused(plan(), {"targets.yaml", "'cup'", "pixels"});
  write_targets("  []\n");
  expect_refused(plan(), {"targets.yaml", "no targets"});
}

/// The near face of the board passes a target 1.5 m away: it hides it until it comes within the
/// radius of 0.05 m and the tolerance of 0.0285 m, and again does nothing once it is as far behind.
constexpr double hidden_until = 1.5 - 0.0785 - 0.95, visible_from = 1.5 + 0.0785 - 0.95;
constexpr double border = 0.005;  // LookAheadConfig::border, seconds

class LookAheadTest : public BagTest {
 protected:
  LookAheadTest() {
    write_targets("- {name: knob, point: [0, 0, 1.5], radius: 0.05, link: base}\n");
    write("plan.csv", "time,slide\n0,0\n1,1\n");
  }

  Outcome look(const Words& options, const fs::path& input) const {
    return penumbra(Words{"look-ahead", input, "-o", out(), "--targets", path("targets.yaml")} +
                    options);
  }
  Outcome look(const std::string& plan, const Words& options = {}) const {
    return look(Words{"--trajectory", path(plan)} + options, path());
  }
  [[nodiscard]] Json seen() const { return read_json(out("look_ahead.json")); }
  [[nodiscard]] Json intervals() const {
    return seen()["motions"][0]["targets"][0]["cameras"][0]["intervals"];
  }
  /// Returns a motion from 0 to `end` in these seconds.
  static io::JointTrajectoryMessage to_message(double end, int seconds) {
    io::JointTrajectoryMessage motion{.joint_names = {"slide"}};
    motion.points = {{.positions = {0.0}},
                     {.positions = {end}, .time_from_start = {.sec = seconds}}};
    return motion;
  }
};

TEST_F(LookAheadTest, TellsWhenAndByWhatATargetIsHidden) {
  expect_has(succeed(look("plan.csv", {"--threads", "2"})).out,
             {"knob", "board", "hidden in", "looked ahead"});
  const Json all = intervals();
  ASSERT_EQ(all.size(), 3U) << all;
  expect_values(all, {{"/0/verdict", "hidden"},
                      {"/0/by", "board"},
                      {"/1/verdict", "unknown"},
                      {"/2/verdict", "visible"},
                      {"/2/end_s", 1.0}});
  EXPECT_EQ(seen()["now"][0]["verdict"], "hidden");
  EXPECT_NEAR(all[0]["end_s"], hidden_until, border);
  EXPECT_NEAR(all[2]["begin_s"], visible_from, border);
  const std::string page = read_file(out("report.html"));
  EXPECT_EQ(page_json(page, "penumbra-report"), seen());
  const Json pictures = page_json(page, "penumbra-pictures");
  ASSERT_EQ(pictures.size(), 2U);
  expect_has(std::string(pictures[0]["caption"]), {"knob is hidden by board from 0.00 to 0.4"});
  EXPECT_EQ(pictures[1]["caption"], "the end, at 1.00 s");
  expect_has(std::string(pictures[1]["image"]), {"data:image/jpeg"});
}

TEST_F(LookAheadTest, ReadsMessagesAndBags) {
  succeed(look("plan.csv"));
  const Json wanted = intervals();
  write("joint.yaml", R"(joint_names: [slide]
points:
- {positions: [0], velocities: [], time_from_start: {sec: 0, nanosec: 0}}
- {positions: [1], time_from_start: {sec: 1, nanosec: 0}}
---
)");
  const auto half = [](const std::string& from, const std::string& to) {
    return R"({"joint_trajectory": {"joint_names": ["slide"], "points": [{"positions": [)" + from +
           R"(], "time_from_start": {"sec": 0}}, {"positions": [)" + to +
           R"(], "time_from_start": {"sec": 0, "nanosec": 500000000}}]}})";
  };
  write("display.json", R"({"model_id": "tiny", "trajectory": [)" + half("0.0", "0.5") + ", " +
                            half("0.5", "1.0") + "]}");
  const std::string ros1 = R"({joint_names: [slide], points: [
  {positions: [0], time_from_start: {secs: 0, nsecs: 0}},
  {positions: [1], time_from_start: {secs: 0, nsecs: 1000000000}}]})";
  write("ros1.yaml", "joint_trajectory: " + ros1);
  write("goal.yaml", "trajectory: " + ros1);  // of FollowJointTrajectory
  write("action.yaml", "goal_id: {id: 3}\ngoal:\n  trajectory: " + ros1);
  for (const char* file : {"joint.yaml", "display.json", "ros1.yaml", "goal.yaml", "action.yaml"}) {
    succeed(look(file));
    EXPECT_EQ(intervals(), wanted) << file;
  }
}

TEST_F(LookAheadTest, TakesTheBagsPlan) {
  succeed(look("plan.csv"));
  const Json wanted = intervals();
  expect_failed(look({}, tiny_mcap()), {"no planned motion", "--trajectory", "--plan-topic"});
  const io::JointTrajectoryMessage motion = to_message(1.0, 1);
  bag_.add("/display_planned_path", tiny_stamp(0),
           io::DisplayTrajectoryMessage{.parts = {{.joints = motion}}});
  bag_.add("/controller/joint_trajectory", tiny_stamp(0), motion);
  for (const Words& named : {Words{}, {"--plan-topic", "/controller/joint_trajectory"}}) {
    succeed(look(named, tiny_mcap()));
    EXPECT_EQ(seen()["frame"], 0);
    EXPECT_EQ(intervals(), wanted);
  }
}

TEST_F(LookAheadTest, RunReportsForecastsOfTheBagsPlan) {
  bag_.add("/joint_trajectory", tiny_stamp(0), to_message(8 * tiny_speed, 8));
  succeed(run({"--targets", path("targets.yaml"), "--plan-topic", "/joint_trajectory"}));
  // The board is on the motion: what it will do comes nearer from frame to frame.
  for (std::size_t i = 0; i < 3; ++i) {
    const Json forecast = report()["frames"][i]["targets"][0]["forecast"];
    ASSERT_TRUE(forecast.is_array()) << i;
    EXPECT_EQ(forecast[0]["verdict"], "hidden");
    EXPECT_EQ(forecast[0]["by"], "board");
    EXPECT_NEAR(forecast.back()["end_s"], 2.0, 1e-6);
  }
}

TEST_F(LookAheadTest, RanksMotions) {
  write("fast.csv", "time,slide\n0,0\n0.2,1\n1,1\n");
  succeed(look("plan.csv", {"--trajectory", path("fast.csv")}));
  const Json ranking = seen()["ranking"];
  EXPECT_EQ(ranking[0]["motion"], path("fast.csv").string());
  EXPECT_GT(ranking[0]["seen"], ranking[1]["seen"]);
  expect_has(std::string(ranking[1]["reason"]), {"knob", "board"});
}

TEST_F(LookAheadTest, SaysWhatThePlanDoesWrong) {
  write("elsewhere.csv", "time,slide\n0,0.5\n1,2\n");
  expect_has(succeed(look("elsewhere.csv", {"--from", "1"})).err,
             {"begins 0.45", "slide", "exceeds its limit by 1 m", "velocity limit by 0.5 m/s"});
  const std::pair<std::string, std::string> plans[] = {
      {"0,0\n1,1\n", ""},
      {"0,0\n0.99,1\n", ""},  // rounding
      {"0,0\n0.5,1\n", "exceeds its velocity limit by 1 m/s at 0 s"},
      {"0,0\n1000,0.9\n2000,0.1\n", "milliseconds"},
      {"0,0\n1000,0\n1001,0.9\n", ""},  // it waits
      {"0,0\n100,0.9\n", ""}};
  for (const auto& [plan, words] : plans) {
    write("plan.csv", "time,slide\n" + plan);
    const std::string err = succeed(look("plan.csv")).err;
    expect_has(err, {words});
    if (words.empty()) expect_lacks(err, {"exceeds", "milliseconds"});
  }
}

TEST_F(LookAheadTest, RunSaysWhatTheBagsPlanDoesWrong) {
  bag_.add("/slow", tiny_stamp(0), to_message(1.0, 2000));
  expect_has(run({"--plan-topic", "/slow"}).err, {"planned motion", "milliseconds"});
  expect_has(notes(), {"milliseconds"});
  const io::JointTrajectoryMessage at_once = to_message(1.0, 0);
  bag_.add("/at_once", tiny_stamp(0), at_once);
  bag_.add(
      "/parts", tiny_stamp(0),
      io::DisplayTrajectoryMessage{.parts = {{.joints = to_message(0.5, 1)}, {.joints = at_once}}});
  for (const char* topic : {"/at_once", "/parts"})
    expect_has(run({"--plan-topic", topic}).err, {"does not rise"});
}

TEST_F(LookAheadTest, RefusesWithOneLine) {
  const auto expect_plan_refused = [&](const std::string& file, const std::string& plan,
                                       const std::string& named) {
    write(file, plan);
    expect_refused(look(file), {named});
  };
  for (const auto& [plan, named] : std::initializer_list<std::pair<std::string, std::string>>{
           {"", "plan.csv"},
           {"slide\n0\n", "time,JOINT"},
           {"time,slide\n", "no points"},
           {"time,elbow\n0,0\n", "elbow"},
           {"time,slide\n0,0\n1,nan\n", "plan.csv:3"},
           {"time,slide\n0,0\n1,1\n1,2\n", "does not rise"},
           {"time,slide\n1700000000,0\n", "0 to 3600 seconds"},
           {"time,slide,slide\n0,0,0\n", "twice"},
           {"time,slide\n0,0\n0,1\n", "does not rise"},
           {"time,slide\n0,0\n1,4294967295\n", "4.29497e+09; expected rad and m"},
           {"time,slide\n0,0\n1,-1e300\n", "expected rad and m"}})
    expect_plan_refused("plan.csv", plan, named);
  const auto message = [](int seconds, const std::string& speed) {
    const auto point = [&](const std::string& position, int time) {
      return "{positions: [" + position + "], velocities: [" + speed +
             "], time_from_start: {sec: " + std::to_string(time) + "}}";
    };
    return "{joint_names: [slide], points: [" + point("0", 0) + ", " + point("0.5", seconds) +
           ", " + point("0.9", 2 * seconds) + "]}\n";
  };
  for (const auto& [plan, named] : std::initializer_list<std::pair<std::string, std::string>>{
           {message(0, "0"), "does not rise"},
           {message(1000, "0.5"), "expected times in seconds"},
           {message(1, "-1e300"), "velocities"},
           {"a: 1\n", "JointTrajectory"}})
    expect_plan_refused("plan.yaml", plan, named);
  EXPECT_EQ(look("nowhere.csv").status, 2);
  write("plan.csv", "time,slide\n0,0\n1,1\n");
  EXPECT_EQ(look("plan.csv", {"--from", "7"}).status, 2);
}

}  // namespace
}  // namespace penumbra::test
