// SPDX-License-Identifier: Apache-2.0
// `penumbra simulate`: what it writes is a recording that `penumbra run` judges as the truth says,
// and a bag is the recording of the same scene and seed in another form.
#include "../apps/fixtures.hpp"
#include "../apps/reference_bag.hpp"
#include "simulated.hpp"

#include <sim/recording_bag.hpp>

namespace penumbra::test {
namespace {

// Labels against MuJoCo's ids: silhouettes of round parts differ by their facets.
constexpr double least_label_union = 99.5;  // percent
constexpr double most_objects_taken = 1.0;  // percent of an object's pixels

// The camera's rotation passes a quaternion on its way through /tf_static, and is off by 1e-16
// then; a virtual depth in float may be rounded the other way, and a pixel at a label's border fall
// to its other side. All else is the same to the last bit.
constexpr double most_labels_apart = 1e-5;    // share of the pixels
constexpr double most_fraction_apart = 0.01;  // of a target's pixels: some on its outline

struct Scene {
  const char* name;
  std::size_t first, end;
  const char* object;
};
constexpr Scene scenes[] = {
    {"conveyor", 75, 79, "parcel"}, {"handover", 133, 137, "wrist"}, {"random", 3, 6, "target_0"}};

/// Rows of a CSV file by the names of its columns.
std::vector<std::map<std::string, std::string>> table(const fs::path& file) {
  std::istringstream lines(read_file(file));
  std::string line, cell;
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    if (!names.empty()) rows.emplace_back();
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i)
      if (names.size() <= i && rows.empty())
        names.push_back(cell);
      else
        rows.back()[names.at(i)] = cell;
  }
  return rows;
}

class SimulateTest : public FolderTest {
 protected:
  void SetUp() override { PENUMBRA_REQUIRE_SIMULATION(); }

  Outcome simulate(const Words& line, const std::string& to) const {
    return penumbra(Words{"simulate"} + line + Words{"-o", path(to)});
  }
  Outcome simulate(const Scene& scene, const std::string& to, const Words& more = {}) const {
    const std::string frames = std::to_string(scene.first) + ":" + std::to_string(scene.end);
    return simulate(Words{scene.name, "--seed", "5", "--frames", frames} + more, to);
  }
  /// Runs an input and keeps its labels.
  [[nodiscard]] Outcome run(const std::string& input, const std::string& to,
                            const Words& more = {}) const {
    return penumbra(Words{"run", path(input), "-o", path(to), "--save", "labels"} + more);
  }

  /// The points of /truth/OBJECT/pose, as a recording names its targets.
  void write_targets(const Scene& scene, const std::string& recording) const {
    std::string points;
    for (const auto& row : table(path(recording) / "truth.csv"))
      if (row.at("object") == scene.object)
        points += (points.empty() ? "" : ", ") + row.at("frame") + ": [" + row.at("x") + ", " +
                  row.at("y") + ", " + row.at("z") + "]";
    write_file(path("targets.yaml"), std::string("targets:\n  - name: ") + scene.object +
                                         "\n    link: base_link\n    point: {frames: {" + points +
                                         "}}\n    radius: 0.02\n");
  }

  /// Compares the labels of of_folder and of_bag.
  void expect_same_labels(const Scene& scene) const {
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < scene.end - scene.first; ++i) {
      const auto a = read_image<std::uint8_t>(path("of_folder/labels") / numbered(scene.first + i));
      const auto b = read_image<std::uint8_t>(path("of_bag/labels") / numbered(i));
      ASSERT_EQ(a.size(), b.size());
      std::size_t apart = 0;
      for (std::size_t p = 0; p < a.size(); ++p) {
        apart += a.data()[p] != b.data()[p] ? 1 : 0;
        hidden += a.data()[p] == 2 ? 1 : 0;
      }
      EXPECT_LE(static_cast<double>(apart), most_labels_apart * static_cast<double>(a.size())) << i;
    }
    EXPECT_GT(hidden, 10'000U);
  }
};

TEST_F(SimulateTest, LabelsOfARecordingAreTheTruth) {
  for (const auto& [scene, frames] : {std::pair("conveyor", "75:79"), {"handover", "133:137"}}) {
    const Words options = {scene, "--seed", "5", "--no-noise", "--frames", frames};
    EXPECT_EQ(succeed(simulate(options, scene)).err, "");
    const std::string results = std::string(scene) + "_results";
    succeed(run(scene, results));
    std::size_t images = 0, both = 0, either = 0, objects = 0, taken = 0;
    for (const auto& entry : fs::directory_iterator(path(scene) / "ids")) {
      ++images;
      const auto said =
          read_image<std::uint8_t>(path(results) / "labels" / entry.path().filename());
      const auto ids = read_image<std::uint16_t>(entry.path());
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const bool hidden = said.data()[i] == 2 || said.data()[i] == 4;
        const bool robot = is_robot(ids.data()[i]), object = ids.data()[i] >= sim::first_object_id;
        both += hidden && robot ? 1 : 0;
        either += hidden || robot ? 1 : 0;
        objects += object ? 1 : 0;
        taken += object && hidden ? 1 : 0;
      }
    }
    EXPECT_EQ(images, 4U);
    ASSERT_GT(either, 10'000U);
    ASSERT_GT(objects, 1000U);
    EXPECT_GT(percent(both, either), least_label_union);
    EXPECT_LT(percent(taken, objects), most_objects_taken);
  }
}

void expect_same_targets(const Json& of_folder, const Json& of_bag, std::size_t frames) {
  EXPECT_EQ(of_folder["frames"].size(), frames);
  EXPECT_EQ(of_bag["frames"].size(), frames);
  const auto number = [](const Json& one) { return one.is_null() ? -1.0 : one.get<double>(); };
  double judged = 0.0;
  for (std::size_t i = 0; i < frames; ++i) {
    const Json& a = of_folder["frames"][i]["targets"].at(0);
    const Json& b = of_bag["frames"][i]["targets"].at(0);
    EXPECT_EQ(a["verdict"], b["verdict"]) << a << b;
    EXPECT_EQ(a["inside"], b["inside"]);
    judged += number(a["inside"]);
    for (const char* fraction : {"occluded_fraction", "front_fraction", "clear_fraction",
                                 "unknown_fraction", "hidden_by_other_fraction"})
      EXPECT_NEAR(number(a[fraction]), number(b[fraction]), most_fraction_apart) << fraction;
  }
  EXPECT_GT(judged, 0.0);
}

TEST_F(SimulateTest, ABagIsJudgedAsTheFolder) {
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    const std::string name = scene.name, bag = name + ".mcap";
    Words noise = {"--joint-sigma", "0.001"};
    if (name != "random") noise.insert(noise.end(), {"--joint-latency", "0.01"});
    succeed(simulate(scene, name, noise));
    EXPECT_EQ(succeed(simulate(scene, bag, noise)).err, "");
    write_targets(scene, name);
    succeed(run(name, "of_folder", {"--targets", path("targets.yaml")}));
    succeed(run(bag, "of_bag"));
    expect_same_labels(scene);
    succeed(
        run(bag, "of_bag", {"--target-topic", std::string("/truth/") + scene.object + "/pose"}));
    expect_same_targets(read_json(path("of_folder/report.json")),
                        read_json(path("of_bag/report.json")), scene.end - scene.first);
  }
}

TEST_F(SimulateTest, ABagOfTwoArmsIsJudgedAsTheFolder) {
  const Scene scene{"two_arms", 0, 3, ""};
  succeed(simulate(scene, "cell"));
  succeed(simulate(scene, "cell.mcap"));
  succeed(run("cell", "of_folder"));
  succeed(run("cell.mcap", "of_bag", {"--robot-namespace", "left", "--robot-namespace", "/right"}));
  expect_same_labels(scene);
  const Outcome wrong =
      run("cell.mcap", "none", {"--robot-namespace", "left", "--robot-namespace", "middle"});
  EXPECT_EQ(wrong.status, 2);
  expect_has(wrong.err, {"/middle/joint_states"});
}

TEST_F(SimulateTest, ABagOfTwoCamerasIsJudgedTogether) {
  const Scene scene{"random", 3, 6, "target_0"};
  const std::string first = "/camera/depth/image_rect_raw",
                    second = "/second_camera/depth/image_rect_raw";
  succeed(simulate(scene, "two.mcap", {"--second-camera"}));
  const auto judged = [&](const std::string& to, const Words& cameras) {
    return run("two.mcap", to, Words{"--target-topic", "/truth/target_0/pose"} + cameras);
  };
  succeed(judged("both", {"--camera", "a=" + first, "--camera", "b=" + second}));
  const Json views = read_json(path("both/views.json"));
  ASSERT_EQ(views["frames"].size(), 3U);
  for (const auto& [name, topic] : {std::pair("a", first), {"b", second}}) {
    succeed(judged("one", {"--depth-topic", topic, "--force"}));
    const Json one = read_json(path("one/report.json"));
    for (std::size_t i = 0; i < 3; ++i) {
      const Json& view = views["frames"][i]["targets"].at(0)["views"];
      const auto same = [camera = name](const Json& each) { return each["camera"] == camera; };
      const auto found = std::find_if(view.begin(), view.end(), same);
      ASSERT_NE(found, view.end());
      EXPECT_EQ((*found)["verdict"], one["frames"][i]["targets"].at(0)["verdict"]);
    }
  }
  expect_failed(judged("none", {"--camera", "a=/camera/none"}), {"/camera/none"});
}

void expect_joints(const Json& message, const std::map<std::string, std::string>& row) {
  EXPECT_EQ(message["name"].size(), row.size() - 2);
  for (std::size_t i = 0; i < message["name"].size(); ++i)
    EXPECT_EQ(message["position"][i].get<double>(), std::stod(row.at(message["name"][i])));
}

void expect_truth(const Json& pose, const Json& target, std::map<std::string, std::string> row) {
  const auto number = [&](const char* column) { return std::stod(row.at(column)); };
  constexpr double rounding = 1e-12;  // of a quaternion made of a matrix, twice
  for (const char* axis : {"x", "y", "z"})
    EXPECT_EQ(pose["pose"]["position"][axis].get<double>(), number(axis));
  double dot = 0;
  for (const char* axis : {"x", "y", "z", "w"})
    dot +=
        pose["pose"]["orientation"][axis].get<double>() * number((std::string("q") + axis).c_str());
  EXPECT_NEAR(std::abs(dot), 1, rounding);
  const double alone = number("pixels_alone"), behind = number("pixels_behind_robot");
  EXPECT_EQ(target["inside"], row.at("pixels_alone"));
  ASSERT_GT(alone, 0);
  EXPECT_NEAR(target["occluded_fraction"].get<double>(), behind / alone, rounding);
  EXPECT_NEAR(target["hidden_by_other_fraction"].get<double>(),
              (alone - behind - number("pixels_seen")) / alone, rounding);
}

TEST_F(SimulateTest, TheReferenceLibraryReadsWhatTheFolderHolds) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  const Scene& scene = scenes[0];
  const Words options = {"--second-camera", "--joint-sigma", "0.001"};
  succeed(simulate(scene, "folder", options));
  succeed(simulate(scene, "bag.mcap", options));
  std::map<std::string, std::vector<Json>> messages;
  for (const Json& one : decoded_messages(path("bag.mcap"))) messages[one["topic"]].push_back(one);
  const auto& descriptions = messages.at("/robot_description");
  ASSERT_EQ(descriptions.size(), 1U);
  EXPECT_EQ(descriptions[0]["message"]["data"],
            read_file(path("folder") / "arm_description" / "arm.urdf"));
  EXPECT_EQ(messages.at("/truth/scene")[0]["message"]["data"],
            read_file(path("folder") / "scene.yaml"));
  EXPECT_EQ(messages.at("/tf_static")[0]["message"]["transforms"].size(), 2U);
  const auto joints = table(path("folder") / "joint_states.csv");
  const auto true_joints = table(path("folder") / "true_joint_states.csv");
  const auto truth = table(path("folder") / "truth.csv");
  ASSERT_EQ(truth.size(), scene.end - scene.first);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    SCOPED_TRACE(i);
    for (const auto& [topic, all] : messages) {
      if (all.size() == 1) continue;
      ASSERT_EQ(all.size(), truth.size()) << topic;
      EXPECT_EQ(all[i]["logTime"], truth[i].at("stamp")) << topic;
      const Json& stamp = all[i]["message"]["header"]["stamp"];
      EXPECT_EQ(stamp["sec"].get<std::int64_t>() * 1'000'000'000 + stamp["nanosec"].get<int>(),
                std::stoll(truth[i].at("stamp")));
    }
    const auto of = [&](const std::string& topic) { return messages.at(topic)[i]["message"]; };
    expect_joints(of("/joint_states"), joints.at(i));
    expect_joints(of("/truth/joint_states"), true_joints.at(i));
    expect_truth(of("/truth/parcel/pose"), of("/truth/targets")["targets"][0], truth[i]);
    const std::string file = numbered(scene.first + i);
    for (const auto& [topic, kind] : {std::pair("/camera/depth/image_rect_raw", "depth"),
                                      {"/second_camera/depth/image_rect_raw", "second_depth"},
                                      {"/truth/ids", "ids"}})
      EXPECT_EQ(of(topic)["data"],
                array_of(read_image<std::uint16_t>(path("folder") / kind / file)))
          << topic;
    const std::string color = read_file(path("folder") / "color" / file);
    EXPECT_EQ(of("/camera/color/image_raw/compressed")["data"]["length"], color.size());
  }
}

TEST_F(SimulateTest, RefusesBadInput) {
  expect_all_refused([this](const Words& line) { return simulate(line, "out"); },
                     {{{"conveyer"}, "conveyor"},
                      {{}, "SCENE"},
                      {{"conveyor", "--seed", "1.5"}, "--seed"},
                      {{"conveyor", "--joint-sigma", "nan"}, "--joint-sigma"},
                      {{"conveyor", "--joint-sigma", "-1"}, "joint_sigma"},
                      {{"conveyor", "--belt-jitter", "2"}, "belt_jitter"},
                      {{"conveyor", "--frames", "5:5"}, "0:150"},
                      {{"conveyor", "--frames", "0:151"}, "0:150"},
                      {{"conveyor", "--duration", "1e99"}, "duration"},
                      {{"conveyor", "--duration", "0"}, "--duration"},
                      {{"conveyor", "--rate", "0"}, "--rate"},
                      {{"conveyor", "--rate", "0.1"}, "--rate"},
                      {{"random", "--joint-latency", "0.1"}, "joint_latency"},
                      {{"handover", "--belt-jitter", "0.3"}, "belt_jitter"}});
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(SimulateTest, RefusesBadOutput) {
  const auto refused = [&](const std::string& to, const std::string& words) {
    expect_refused(simulate(scenes[0], to), {words});
  };
  refused("bag.db3", "bags are written as .mcap");
  refused("nowhere/bag.mcap", "No such file or directory");
  EXPECT_TRUE(fs::is_empty(path()));

  write_file(path("mine.mcap"), "mine");
  refused("mine.mcap", "mine.mcap is there");
  EXPECT_EQ(read_file(path("mine.mcap")), "mine");

  fs::create_directory(path("arm_description"));
  write_file(path("arm_description/arm.urdf"), "<robot/>");
  refused("bag.mcap", "does not hold the simulated arm's meshes");
  EXPECT_EQ(read_file(path("arm_description/arm.urdf")), "<robot/>");
  EXPECT_EQ(std::distance(fs::directory_iterator(path()), fs::directory_iterator()), 2);
}

}  // namespace
}  // namespace penumbra::test
