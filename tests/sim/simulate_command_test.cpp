// SPDX-License-Identifier: Apache-2.0
// `penumbra simulate`: what it writes is a recording that `penumbra run` judges as the truth says.
#include "../apps/program.hpp"
#include "simulated.hpp"

#include <filesystem>

#include <io/files/png.hpp>

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

// Labels against MuJoCo's ids: silhouettes of round parts differ by their facets.
constexpr double least_label_union = 0.995;
constexpr double most_objects_taken = 0.01;  // of an object's pixels

class SimulateCommand : public testing::Test {
 protected:
  void SetUp() override { PENUMBRA_REQUIRE_SIMULATION(); }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  Outcome simulate(std::vector<std::string> line, const std::string& to) {
    line.insert(line.begin(), "simulate");
    line.insert(line.end(), {"-o", path(to)});
    return penumbra(line);
  }

  TemporaryFolder folder_;
};

struct Counts {
  std::size_t both = 0, either = 0, objects = 0, taken = 0;
};

void count(const fs::path& labels_file, const fs::path& ids_file, Counts& counts) {
  Image<std::uint8_t> labels;
  Image<std::uint16_t> ids;
  ASSERT_TRUE(io::read_png(labels_file, labels).ok()) << labels_file;
  ASSERT_TRUE(io::read_png(ids_file, ids).ok()) << ids_file;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::uint8_t label = labels.data()[i];
    const std::uint16_t id = ids.data()[i];
    const bool hidden = label == 2 || label == 4, robot = id > 0 && id < sim::first_object_id;
    counts.both += hidden && robot ? 1 : 0;
    counts.either += hidden || robot ? 1 : 0;
    counts.objects += id >= sim::first_object_id ? 1 : 0;
    counts.taken += id >= sim::first_object_id && hidden ? 1 : 0;
  }
}

TEST_F(SimulateCommand, LabelsOfARecordingAreTheTruth) {
  for (const auto& [scene, frames] : {std::pair("conveyor", "75:79"), {"handover", "133:137"}}) {
    const Outcome made = simulate({scene, "--seed", "5", "--no-noise", "--frames", frames}, scene);
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(made.err, "");
    const std::string results = std::string(scene) + "_results";
    const Outcome run = penumbra({"run", path(scene), "-o", path(results), "--save", "labels"});
    ASSERT_EQ(run.status, 0) << run.err;
    Counts counts;
    std::size_t images = 0;
    for (const auto& entry : fs::directory_iterator(path(scene) / "ids")) {
      count(path(results) / "labels" / entry.path().filename(), entry.path(), counts);
      ++images;
    }
    EXPECT_EQ(images, 4U);
    ASSERT_GT(counts.either, 10'000U);
    ASSERT_GT(counts.objects, 1000U);
    EXPECT_GT(static_cast<double>(counts.both) / static_cast<double>(counts.either),
              least_label_union);
    EXPECT_LT(static_cast<double>(counts.taken) / static_cast<double>(counts.objects),
              most_objects_taken);
  }
}

TEST_F(SimulateCommand, RefusesBadInput) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"conveyer"}, "conveyor"},
      {{}, "SCENE"},
      {{"conveyor", "--seed", "1.5"}, "--seed"},
      {{"conveyor", "--joint-sigma", "nan"}, "--joint-sigma"},
      {{"conveyor", "--joint-sigma", "-1"}, "joint_sigma"},
      {{"conveyor", "--belt-jitter", "2"}, "belt_jitter"},
      {{"conveyor", "--frames", "5:5"}, "0:150"},
      {{"conveyor", "--frames", "0:151"}, "0:150"},
      {{"conveyor", "--duration", "1e99"}, "duration"},
      {{"conveyor", "--duration", "0"}, "--duration"},
      {{"conveyor", "--rate", "0"}, "frame_rate"},
      {{"conveyor", "--rate", "0.1"}, "--rate"},
      {{"random", "--joint-latency", "0.1"}, "joint_latency"},
      {{"handover", "--belt-jitter", "0.3"}, "belt_jitter"}};
  for (const auto& [line, named] : cases) {
    const Outcome outcome = simulate(line, "out");
    EXPECT_EQ(outcome.status, 2) << named;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(path("out"))) << named;
  }
}

}  // namespace
}  // namespace penumbra::test
