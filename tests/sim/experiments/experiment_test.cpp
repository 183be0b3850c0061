// SPDX-License-Identifier: Apache-2.0
// Both experiments in small, through the door that the command line uses.
#include "../../support/page_json.hpp"
#include "../../support/run_length.hpp"
#include "../../support/temporary_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>

#include <sim/experiments/detector.hpp>
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
  const TemporaryFolder folder;
  options.output = folder.path() / "results";
  Results results;
  sim::run_experiment(
      options, [&](std::size_t total) { results.total = total; }, [&] { ++results.steps; });
  results.metrics = text_of(options.output / "metrics.json");
  results.report = text_of(options.output / "report.html");
  return results;
}

double value(const json& lane, const std::string& method, const std::string& measure) {
  return lane.at("methods").at(method).at("summary").at(measure).at("value").get<double>();
}

json value_or_null(const Results& results, const std::string& lane, const std::string& measure) {
  return json::parse(results.metrics)
      .at("detections")
      .at(lane)
      .at("methods")
      .at("penumbra")
      .at("summary")
      .at(measure)
      .at("value");
}

/// Of the frames in which the target is hidden and a pose is claimed, by the page's own series.
double hidden_p95(const json& shown, const std::string& lane, const std::string& method) {
  const json& run = shown.at("run");
  const json& errors = run.at("lanes").at(lane).at("errors").at(method).at("translation_mm");
  std::vector<double> all;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const bool counts = run.at("counted").at(i).get<bool>() &&
                        run.at("hidden").at(i).get<double>() > shown.at("occluded_share");
    if (counts && !errors.at(i).is_null()) all.push_back(errors.at(i));
  }
  std::sort(all.begin(), all.end());
  const double place = 0.95 * static_cast<double>(all.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double above = all.at(std::min(below + 1, all.size() - 1));
  return all.at(below) + (place - static_cast<double>(below)) * (above - all.at(below));
}

constexpr double page_digits = 1e-3;  // mm: the page's series have three digits

/// The page holds metrics.json as it is, the first seed's frames make that seed's measures, and
/// pictures are of such frames.
void expect_tells(const Results& results) {
  const json metrics = json::parse(results.metrics);
  EXPECT_EQ(page_json(results.report, "penumbra-report"), metrics);
  const json shown = page_json(results.report, "penumbra-experiment");
  for (const auto& [lane, detection] : metrics.at("detections").items())
    for (const auto& [method, measured] : detection.at("methods").items())
      EXPECT_NEAR(hidden_p95(shown, lane, method),
                  measured.at("seeds").at(0).at("translation_p95_mm").get<double>(), page_digits)
          << lane << ", " << method;
  const json& verdicts = shown.at("run").at("lanes").front().at("verdicts");
  const auto count = [&](const json& verdict) {
    return std::count(verdicts.begin(), verdicts.end(), verdict);
  };
  EXPECT_GT(count("visible"), 0);
  EXPECT_GT(count("partial") + count("hidden"), 0);
  const json pictures = page_json(results.report, "penumbra-frames");
  EXPECT_GE(pictures.size(), 4U);
  for (const json& picture : pictures) {
    EXPECT_TRUE(picture.at("image").get<std::string>().starts_with("data:image/jpeg;base64,/9j/"));
    EXPECT_LT(picture.at("index").get<std::size_t>(), shown.at("run").at("time_s").size());
  }
}

// docs/experiments.md has 4 and 7 mm over 30 seeds, a tenth and less of what comes without a
// tracker, trackers within 10 % of ours with a careful estimator and worse with an eager one. Two
// seeds spread more: with an eager estimator ours may then be 0.15 of what comes without a tracker.
constexpr double careful_p95 = 8.0, eager_p95 = 14.0;  // mm
constexpr double careful_share = 0.1, eager_share = 0.15, alike = 1.5;

TEST(Experiment, ConveyorFollowsWhatTheArmHides) {
  const Results results = run({.experiment = "conveyor", .end_seed = 2, .output = {}});
  EXPECT_EQ(results.steps, results.total);
  const json metrics = json::parse(results.metrics);
  for (const char* const lane : {"amodal", "modal", "amodal_eager", "modal_eager"}) {
    const json& methods = metrics.at("detections").at(lane);
    EXPECT_EQ(value(methods, "penumbra", "wrong_accepted_hidden"), 0.0);
    EXPECT_EQ(value(methods, "penumbra", "success_percent"), 100.0);
    const double p95 = value(methods, "penumbra", "translation_p95_mm");
    const bool is_eager = std::string(lane).ends_with("_eager");
    EXPECT_LT(p95, is_eager ? eager_p95 : careful_p95);
    for (const char* const untracked : {"raw", "height_raw", "silhouette_raw", "urdf_filter_raw"})
      EXPECT_LT(p95, (is_eager ? eager_share : careful_share) *
                         value(methods, untracked, "translation_p95_mm"))
          << lane << ", " << untracked;
    for (const char* const tracked :
         {"tracker", "height", "silhouette", "urdf_filter", "own_model"})
      EXPECT_LT(p95, (is_eager ? 1.0 : alike) * value(methods, tracked, "translation_p95_mm"))
          << lane << ", " << tracked;
  }
  expect_tells(results);
}

TEST(Experiment, HandoverKeepsTheHandBeforeTheArm) {
  const std::uint64_t seeds = is_full_run() ? 2 : 1;
  const Results results = run({.experiment = "handover", .end_seed = seeds, .output = {}});
  EXPECT_EQ(results.steps, results.total);
  const json lane = json::parse(results.metrics).at("detections").at("keypoint");
  EXPECT_EQ(value(lane, "penumbra", "on_robot_accepted"), 0.0);
  EXPECT_GT(value(lane, "raw", "on_robot_accepted"), 0.0);
  constexpr double few = 10.0, many = 30.0;  // percent
  EXPECT_EQ(value(lane, "penumbra", "success_percent"), 100.0);
  // 80 mm over 30 seeds, with the robot's silhouette subtracted 83 mm, 350 mm without handling.
  const double p95 = value(lane, "penumbra", "translation_p95_mm");
  EXPECT_LT(p95, 120.0);
  for (const char* const filter : {"silhouette", "urdf_filter"})
    EXPECT_LT(p95, 1.2 * value(lane, filter, "translation_p95_mm")) << filter;
  for (const char* const fooled : {"raw", "tracker", "height_raw", "height"})
    EXPECT_LT(p95, 0.5 * value(lane, fooled, "translation_p95_mm")) << fooled;
  EXPECT_LT(value(lane, "penumbra", "refused_before_robot_percent"), few);
  EXPECT_GT(value(lane, "silhouette", "refused_before_robot_percent"), many);
  EXPECT_LT(value(lane, "urdf_filter", "refused_before_robot_percent"), few)
      << "realtime_urdf_filter keeps what stands before the robot";
  expect_tells(results);
}

TEST(Experiment, DoesNotDependOnTheNumberOfThreads) {
  const Results one =
      run({.experiment = "conveyor", .end_seed = 2, .duration = 1.0, .threads = 1, .output = {}});
  const Results two =
      run({.experiment = "conveyor", .end_seed = 2, .duration = 1.0, .threads = 2, .output = {}});
  EXPECT_EQ(one.metrics, two.metrics);
  EXPECT_EQ(one.report, two.report);
}

/// A run that ends before the grasp has none to tell of, and no errors while hidden to draw.
TEST(Experiment, AShortRunHasNoGrasp) {
  const Results results =
      run({.experiment = "conveyor", .end_seed = 1, .duration = 0.5, .output = {}});
  const json lane = json::parse(results.metrics).at("detections").at("amodal");
  const json& summary = lane.at("methods").at("penumbra").at("summary");
  EXPECT_TRUE(summary.at("success_percent").at("value").is_null());
  EXPECT_TRUE(summary.at("wrong_accepted").at("ci95").is_null()) << "of one seed";
  EXPECT_TRUE(page_json(results.report, "penumbra-experiment").at("run").at("goal").is_null());
  for (const json& picture : page_json(results.report, "penumbra-frames"))
    EXPECT_NE(picture.at("title"), "Grasp");
  const Results hand =
      run({.experiment = "handover", .end_seed = 1, .duration = 0.5, .output = {}});
  EXPECT_TRUE(value_or_null(hand, "keypoint", "success_percent").is_null());
}

/// Finds nothing: what a caller's own detector says is what is used.
class Blind : public sim::Detector {
 public:
  std::optional<sim::Detection> detect(const sim::SimFrame&) override { return std::nullopt; }
};
class BlindToHands : public sim::KeypointDetector {
 public:
  std::optional<sim::Keypoint> detect(const sim::SimFrame&) override { return std::nullopt; }
};

TEST(Experiment, TakesDetectorsOfOnesOwn) {
  const Results conveyor =
      run({.experiment = "conveyor",
           .end_seed = 1,
           .duration = 0.5,
           .output = {},
           .detector = [](const sim::Cell&, std::uint64_t) { return std::make_unique<Blind>(); }});
  const json lanes = json::parse(conveyor.metrics).at("detections");
  EXPECT_EQ(lanes.size(), 2U) << "a careful and an eager estimator";
  EXPECT_TRUE(lanes.contains("own") && lanes.contains("own_eager"));
  const Results handover = run({.experiment = "handover",
                                .end_seed = 1,
                                .duration = 1.5,
                                .output = {},
                                .keypoint_detector = [](const sim::Cell&, std::uint64_t) {
                                  return std::make_unique<BlindToHands>();
                                }});
  EXPECT_TRUE(value_or_null(handover, "keypoint", "refused_visible_percent").is_null())
      << "nothing was ever answered";
}

/// Before the runs, which take minutes.
TEST(Experiment, AFolderThatCannotBeWrittenIsRefusedAtOnce) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path() / "unwritable";
  for (const char* const taken : {"metrics.json", "report.html", "frames"}) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    if (std::string(taken) == "frames")
      std::ofstream(folder / taken) << "mine";
    else
      std::filesystem::create_directories(folder / taken / "mine");
    const bool has_former = std::string(taken) == "report.html";
    if (has_former) std::ofstream(folder / "metrics.json") << "former";
    std::size_t steps = 0;
    EXPECT_THROW(sim::run_experiment(
                     {.experiment = "handover",
                      .end_seed = 1,
                      .duration = 0.2,
                      .frames = true,
                      .output = folder},
                     [](std::size_t) {}, [&] { ++steps; }),
                 InputError)
        << taken;
    EXPECT_EQ(steps, 0U) << taken;
    if (has_former) {
      EXPECT_EQ(text_of(folder / "metrics.json"), "former");
    }
    const auto left = std::filesystem::directory_iterator(folder);
    for (const auto& entry : left) EXPECT_FALSE(entry.is_regular_file() && entry.file_size() == 0);
  }
}

TEST(Experiment, RefusesWhatMakesNoSense) {
  EXPECT_THROW(run({.experiment = "lunch", .output = {}}), InputError);
  EXPECT_THROW(run({.experiment = "conveyor", .first_seed = 3, .end_seed = 3, .output = {}}),
               InputError);
}

}  // namespace
}  // namespace penumbra::test
