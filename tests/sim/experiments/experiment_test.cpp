// SPDX-License-Identifier: Apache-2.0
// Both experiments in small, through the door that the command line uses.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>

#include <sim/experiments/experiment.hpp>

namespace penumbra::test {
namespace {

using nlohmann::json;

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

struct Results {
  std::string metrics, report;
  std::size_t total = 0, steps = 0;
};

Results run(sim::ExperimentOptions options) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) /
                                       (options.experiment + std::to_string(options.threads));
  std::filesystem::remove_all(folder);
  options.output = folder;
  Results results;
  sim::run_experiment(
      options, [&](std::size_t total) { results.total = total; }, [&] { ++results.steps; });
  results.metrics = text_of(folder / "metrics.json");
  results.report = text_of(folder / "report.html");
  std::filesystem::remove_all(folder);
  return results;
}

double value(const json& lane, const std::string& method, const std::string& measure) {
  return lane.at("methods").at(method).at("summary").at(measure).at("value").get<double>();
}

TEST(Experiment, ConveyorFollowsWhatTheArmHides) {
  const Results results = run({.experiment = "conveyor", .end_seed = 2, .output = {}});
  EXPECT_EQ(results.steps, results.total);
  const json metrics = json::parse(results.metrics);
  for (const char* const lane : {"amodal", "modal", "amodal_eager", "modal_eager"}) {
    const json& methods = metrics.at("detections").at(lane);
    EXPECT_EQ(value(methods, "penumbra", "wrong_accepted_hidden"), 0.0);
    EXPECT_LT(value(methods, "penumbra", "translation_p95_mm"),
              value(methods, "raw", "translation_p95_mm"));
  }
  EXPECT_NE(results.report.find("data:image/webp;base64,"), std::string::npos);
  EXPECT_EQ(results.report.find("http"), std::string::npos) << "the report is one file";
}

TEST(Experiment, HandoverKeepsTheHandBeforeTheArm) {
  const Results results = run({.experiment = "handover", .end_seed = 2, .output = {}});
  EXPECT_EQ(results.steps, results.total);
  const json lane = json::parse(results.metrics).at("detections").at("keypoint");
  EXPECT_EQ(value(lane, "penumbra", "on_robot_accepted"), 0.0);
  EXPECT_GT(value(lane, "raw", "on_robot_accepted"), 0.0);
  constexpr double few = 10.0, many = 30.0;  // percent
  EXPECT_LT(value(lane, "penumbra", "refused_before_robot_percent"), few);
  EXPECT_GT(value(lane, "urdf_filter", "refused_before_robot_percent"), many);
}

TEST(Experiment, DoesNotDependOnTheNumberOfThreads) {
  const Results one =
      run({.experiment = "conveyor", .end_seed = 2, .duration = 1.0, .threads = 1, .output = {}});
  const Results two =
      run({.experiment = "conveyor", .end_seed = 2, .duration = 1.0, .threads = 2, .output = {}});
  EXPECT_EQ(one.metrics, two.metrics);
  EXPECT_EQ(one.report, two.report);
}

TEST(Experiment, RefusesWhatMakesNoSense) {
  EXPECT_THROW(run({.experiment = "lunch", .output = {}}), InputError);
  EXPECT_THROW(run({.experiment = "conveyor", .first_seed = 3, .end_seed = 3, .output = {}}),
               InputError);
}

}  // namespace
}  // namespace penumbra::test
