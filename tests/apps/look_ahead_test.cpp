// SPDX-License-Identifier: Apache-2.0
// penumbra look-ahead on the tiny recording, whose board moves along the optical axis.
#include "../support/page_json.hpp"
#include "fixtures.hpp"

#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

/// The near face of the board passes a target 1.5 m away: it hides it until it comes within the
/// radius of 0.05 m and the tolerance of 0.0285 m, and again does nothing once it is as far behind.
constexpr double hidden_until = 1.5 - 0.0785 - 0.95, visible_from = 1.5 + 0.0785 - 0.95;
constexpr double border = 0.005;  // LookAheadConfig::border, seconds

class LookAheadTest : public BagTest {
 protected:
  LookAheadTest() {
    write_file(path("targets.yaml"),
               "targets:\n- {name: knob, point: [0, 0, 1.5], radius: 0.05, link: base}\n");
    write_file(path("plan.csv"), "time,slide\n0,0\n1,1\n");
  }

  Outcome look(const std::string& plan, Words options = {}, const std::string& input = "") const {
    options.insert(options.begin(),
                   {"look-ahead", input.empty() ? path() : path(input), "-o", out(), "--targets",
                    path("targets.yaml"), "--trajectory", path(plan)});
    return penumbra(options);
  }
  [[nodiscard]] Json seen() const { return Json::parse(read_file(out() / "look_ahead.json")); }
  [[nodiscard]] Json intervals() const {
    return seen()["motions"][0]["targets"][0]["cameras"][0]["intervals"];
  }
};

TEST_F(LookAheadTest, TellsWhenAndByWhatATargetIsHidden) {
  const Outcome outcome = look("plan.csv", {"--threads", "2"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_has(outcome.out, {"knob", "board", "hidden in", "looked ahead"});
  const Json all = intervals();
  ASSERT_EQ(all.size(), 3U) << all;
  EXPECT_EQ(all[0]["verdict"], "hidden");
  EXPECT_EQ(all[0]["by"], "board");
  EXPECT_NEAR(all[0]["end_s"], hidden_until, border);
  EXPECT_EQ(all[1]["verdict"], "unknown");
  EXPECT_EQ(all[2]["verdict"], "visible");
  EXPECT_NEAR(all[2]["begin_s"], visible_from, border);
  EXPECT_EQ(all[2]["end_s"], 1.0);
  EXPECT_EQ(seen()["now"][0]["verdict"], "hidden");
  const std::string page = read_file(out() / "report.html");
  EXPECT_EQ(page_json(page, "penumbra-report"), seen());
  const Json pictures = page_json(page, "penumbra-pictures");
  ASSERT_EQ(pictures.size(), 2U);
  expect_has(std::string(pictures[0]["caption"]), {"knob is hidden by board from 0.00 to 0.4"});
  EXPECT_EQ(pictures[1]["caption"], "the end, at 1.00 s");
  expect_has(std::string(pictures[1]["image"]), {"data:image/jpeg"});
}

TEST_F(LookAheadTest, ReadsMessagesAndBags) {
  ASSERT_EQ(look("plan.csv").status, 0);
  const Json wanted = intervals();
  const std::string motion =
      "joint_names: [slide]\npoints:\n- {positions: [0], velocities: [], time_from_start: {sec: 0, "
      "nanosec: 0}}\n- {positions: [1], time_from_start: {sec: 1, nanosec: 0}}\n";
  write_file(path("joint.yaml"), motion + "---\n");
  const std::string json =
      R"({"joint_names": ["slide"], "points": [{"positions": [0.0], "time_from_start": {"sec": 0}},
      {"positions": [0.5], "time_from_start": {"sec": 0, "nanosec": 500000000}}]})";
  const std::string rest =
      R"({"joint_names": ["slide"], "points": [{"positions": [0.5], "time_from_start": {"sec": 0}},
      {"positions": [1.0], "time_from_start": {"sec": 0, "nanosec": 500000000}}]})";
  write_file(path("display.json"), R"({"model_id": "tiny", "trajectory": [{"joint_trajectory": )" +
                                       json + R"(}, {"joint_trajectory": )" + rest + "}]}");
  for (const char* file : {"joint.yaml", "display.json"}) {
    const Outcome outcome = look(file);
    ASSERT_EQ(outcome.status, 0) << file << outcome.err;
    EXPECT_EQ(intervals(), wanted) << file;
  }
  bag_.write_mcap(path("tiny.mcap"));
  const Outcome of_bag = look("plan.csv", {}, "tiny.mcap");
  ASSERT_EQ(of_bag.status, 0) << of_bag.err;
  EXPECT_EQ(intervals(), wanted);
}

TEST_F(LookAheadTest, TakesTheBagsPlan) {
  ASSERT_EQ(look("plan.csv").status, 0);
  const Json wanted = intervals();
  io::JointTrajectoryMessage motion{.joint_names = {"slide"}};
  motion.points.push_back({.positions = {0.0}});
  motion.points.push_back({.positions = {1.0}, .time_from_start = {.sec = 1}});
  const std::string bag = path("tiny.mcap");
  bag_.write_mcap(bag);
  const Words command = {"look-ahead", bag, "-o", out(), "--targets", path("targets.yaml")};
  const Outcome without = penumbra(command);
  EXPECT_EQ(without.status, 2);
  expect_has(without.err, {"no planned motion", "--trajectory", "--plan-topic"});
  bag_.add("/display_planned_path", tiny_stamp(0),
           io::DisplayTrajectoryMessage{.parts = {{.joints = motion}}});
  bag_.add("/controller/joint_trajectory", tiny_stamp(0), motion);
  bag_.write_mcap(bag);
  for (const bool is_named : {false, true}) {
    Words with = command;
    if (is_named) with.insert(with.end(), {"--plan-topic", "/controller/joint_trajectory"});
    const Outcome outcome = penumbra(with);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(seen()["frame"], 0);
    EXPECT_EQ(intervals(), wanted);
  }
}

TEST_F(LookAheadTest, RunReportsForecastsOfTheBagsPlan) {
  io::JointTrajectoryMessage motion{.joint_names = {"slide"}};
  for (const int second : {0, 8})
    motion.points.push_back(
        {.positions = {tiny_speed * second}, .time_from_start = {.sec = second}});
  bag_.add("/joint_trajectory", tiny_stamp(0), motion);
  ASSERT_EQ(run({"--targets", path("targets.yaml"), "--plan-topic", "/joint_trajectory"}).status,
            0);
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
  write_file(path("fast.csv"), "time,slide\n0,0\n0.2,1\n1,1\n");
  const Outcome outcome = look("plan.csv", {"--trajectory", path("fast.csv")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json ranking = seen()["ranking"];
  EXPECT_EQ(ranking[0]["motion"], path("fast.csv").string());
  EXPECT_GT(ranking[0]["seen"], ranking[1]["seen"]);
  expect_has(std::string(ranking[1]["reason"]), {"knob", "board"});
}

TEST_F(LookAheadTest, SaysWhatThePlanDoesWrong) {
  write_file(path("elsewhere.csv"), "time,slide\n0,0.5\n1,2\n");
  const Outcome outcome = look("elsewhere.csv", {"--from", "1"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_has(outcome.err, {"begins 0.45", "slide", "exceeds its limit by 1 m"});
}

TEST_F(LookAheadTest, RefusesWithOneLine) {
  const std::vector<std::pair<std::string, std::string>> plans = {
      {"", "plan.csv"},
      {"slide\n0\n", "time,JOINT"},
      {"time,slide\n", "no points"},
      {"time,elbow\n0,0\n", "elbow"},
      {"time,slide\n0,0\n1,nan\n", "plan.csv:3"},
      {"time,slide\n0,0\n1,1\n1,2\n", "does not rise"},
      {"time,slide\n-1,0\n", "0 to 3600 seconds"},
      {"time,slide\n1700000000,0\n", "0 to 3600 seconds"},
      {"time,slide,slide\n0,0,0\n", "twice"}};
  for (const auto& [plan, named] : plans) {
    write_file(path("plan.csv"), plan);
    const Outcome outcome = look("plan.csv");
    EXPECT_EQ(outcome.status, 2) << plan;
    expect_has(outcome.err, {named});
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  }
  write_file(path("plan.yaml"), "a: 1\n");
  EXPECT_EQ(look("plan.yaml").status, 2);
  EXPECT_EQ(look("nowhere.csv").status, 2);
  write_file(path("plan.csv"), "time,slide\n0,0\n1,1\n");
  EXPECT_EQ(look("plan.csv", {"--from", "7"}).status, 2);
}

}  // namespace
}  // namespace penumbra::test
