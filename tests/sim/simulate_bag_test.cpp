// SPDX-License-Identifier: Apache-2.0
// `penumbra simulate -o NAME.mcap`: the bag is the recording folder of the same scene and seed, in
// another form.
#include "../apps/program.hpp"
#include "../support/node_scripts.hpp"
#include "simulated.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include <io/files/png.hpp>
#include <io/mcap/compression.hpp>
#include <sim/recording_bag.hpp>

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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

template <typename T>
Image<T> read_image(const fs::path& file) {
  Image<T> image;
  io::read_png(file, image).require();
  return image;
}

std::string digits(std::size_t number) {
  std::string text = std::to_string(number);
  return text.insert(0, 6 - text.size(), '0') + ".png";
}

class SimulateBag : public testing::Test {
 protected:
  void SetUp() override { PENUMBRA_REQUIRE_SIMULATION(); }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  [[nodiscard]] Outcome simulate(const Scene& scene, const std::string& to,
                                 std::vector<std::string> more = {}) const {
    const std::string frames = std::to_string(scene.first) + ":" + std::to_string(scene.end);
    more.insert(more.begin(),
                {"simulate", scene.name, "--seed", "5", "--frames", frames, "-o", path(to)});
    return penumbra(more);
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

  TemporaryFolder folder_;
};

void compare_labels(const fs::path& one, const fs::path& other, std::size_t& hidden) {
  const auto a = read_image<std::uint8_t>(one), b = read_image<std::uint8_t>(other);
  ASSERT_EQ(a.size(), b.size());
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    apart += a.data()[i] != b.data()[i] ? 1 : 0;
    hidden += a.data()[i] == 2 ? 1 : 0;
  }
  EXPECT_LE(static_cast<double>(apart), most_labels_apart * static_cast<double>(a.size())) << one;
}

/// Answers how many targets were judged.
int compare_targets(const json& of_folder, const json& of_bag, std::size_t frames) {
  EXPECT_EQ(of_folder["frames"].size(), frames);
  EXPECT_EQ(of_bag["frames"].size(), frames);
  int judged = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const json& a = of_folder["frames"][i]["targets"].at(0);
    const json& b = of_bag["frames"][i]["targets"].at(0);
    EXPECT_EQ(a["verdict"], b["verdict"]) << a << b;
    EXPECT_EQ(a["inside"], b["inside"]);
    for (const char* fraction : {"occluded_fraction", "front_fraction", "clear_fraction",
                                 "unknown_fraction", "hidden_by_other_fraction"}) {
      EXPECT_EQ(a[fraction].is_null(), b[fraction].is_null()) << fraction;
      if (a[fraction].is_null()) continue;
      EXPECT_NEAR(a[fraction].get<double>(), b[fraction].get<double>(), most_fraction_apart);
      ++judged;
    }
  }
  return judged;
}

TEST_F(SimulateBag, IsJudgedAsTheFolder) {
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    const std::string name = scene.name, bag = name + ".mcap";
    std::vector<std::string> noise = {"--joint-sigma", "0.001"};
    if (name != "random") noise.insert(noise.end(), {"--joint-latency", "0.01"});
    ASSERT_EQ(simulate(scene, name, noise).status, 0);
    const Outcome made = simulate(scene, bag, noise);
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(made.err, "");
    write_targets(scene, name);
    const Outcome folder = penumbra({"run", path(name), "-o", path("of_folder"), "--save", "labels",
                                     "--targets", path("targets.yaml")});
    ASSERT_EQ(folder.status, 0) << folder.err;
    const Outcome plain = penumbra({"run", path(bag), "-o", path("of_bag"), "--save", "labels"});
    ASSERT_EQ(plain.status, 0) << plain.err;
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < scene.end - scene.first; ++i)
      compare_labels(path("of_folder") / "labels" / digits(scene.first + i),
                     path("of_bag") / "labels" / digits(i), hidden);
    EXPECT_GT(hidden, 10'000U);

    const std::string topic = std::string("/truth/") + scene.object + "/pose";
    const Outcome judged =
        penumbra({"run", path(bag), "-o", path("of_bag"), "--target-topic", topic});
    ASSERT_EQ(judged.status, 0) << judged.err;
    EXPECT_GT(compare_targets(json::parse(read_file(path("of_folder") / "report.json")),
                              json::parse(read_file(path("of_bag") / "report.json")),
                              scene.end - scene.first),
              0);
  }
}

TEST_F(SimulateBag, OfTwoArmsIsJudgedAsTheFolder) {
  const Scene scene{"two_arms", 0, 3, ""};
  ASSERT_EQ(simulate(scene, "cell").status, 0);
  ASSERT_EQ(simulate(scene, "cell.mcap").status, 0);
  ASSERT_EQ(penumbra({"run", path("cell"), "-o", path("of_folder"), "--save", "labels"}).status, 0);
  const Outcome bag = penumbra({"run", path("cell.mcap"), "-o", path("of_bag"), "--save", "labels",
                                "--robot-namespace", "left", "--robot-namespace", "/right"});
  ASSERT_EQ(bag.status, 0) << bag.err;
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < 3; ++i)
    compare_labels(path("of_folder") / "labels" / digits(i), path("of_bag") / "labels" / digits(i),
                   hidden);
  EXPECT_GT(hidden, 10'000U);
  const Outcome wrong = penumbra({"run", path("cell.mcap"), "-o", path("none"), "--robot-namespace",
                                  "left", "--robot-namespace", "middle"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("/middle/joint_states"), std::string::npos) << wrong.err;
}

TEST_F(SimulateBag, OfTwoCamerasIsJudgedTogether) {
  const Scene scene{"random", 3, 6, "target_0"};
  ASSERT_EQ(simulate(scene, "two.mcap", {"--second-camera"}).status, 0);
  const std::vector<std::string> run = {"run", path("two.mcap"), "--target-topic",
                                        "/truth/target_0/pose", "-o"};
  const auto judged = [&](const std::string& out, const std::vector<std::string>& cameras) {
    std::vector<std::string> all = run;
    all.push_back(path(out));
    all.insert(all.end(), cameras.begin(), cameras.end());
    return penumbra(all);
  };
  const Outcome both = judged("both", {"--camera", "a=/camera/depth/image_rect_raw", "--camera",
                                       "b=/second_camera/depth/image_rect_raw"});
  ASSERT_EQ(both.status, 0) << both.err;
  const json views = json::parse(read_file(path("both") / "views.json"));
  ASSERT_EQ(views["frames"].size(), 3U);
  for (const auto& [name, topic] : {std::pair("a", "/camera/depth/image_rect_raw"),
                                    {"b", "/second_camera/depth/image_rect_raw"}}) {
    ASSERT_EQ(judged("one", {"--depth-topic", topic, "--force"}).status, 0);
    const json one = json::parse(read_file(path("one") / "report.json"));
    for (std::size_t i = 0; i < 3; ++i) {
      const json& view = views["frames"][i]["targets"].at(0)["views"];
      const auto same = [camera = name](const json& each) { return each["camera"] == camera; };
      const auto found = std::find_if(view.begin(), view.end(), same);
      ASSERT_NE(found, view.end());
      EXPECT_EQ((*found)["verdict"], one["frames"][i]["targets"].at(0)["verdict"]);
    }
  }
  const Outcome wrong = judged("none", {"--camera", "a=/camera/none"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("/camera/none"), std::string::npos) << wrong.err;
}

/// What decode.mjs says of an image's bytes.
template <typename T>
json array_of(const Image<T>& image) {
  char crc[9];
  std::snprintf(crc, sizeof crc, "%08x",
                io::mcap::crc32(std::as_bytes(std::span(image.data(), image.size()))));
  return {{"length", image.size() * sizeof(T)}, {"crc", crc}};
}

/// Messages of a bag as the reference library reads them, by topic.
std::map<std::string, std::vector<json>> decoded(const fs::path& bag) {
  const ScriptResult checked = run_script("read_back.mjs", "'" + bag.string() + "'");
  EXPECT_EQ(checked.status, 0) << checked.errors;
  const ScriptResult told = run_script("decode.mjs", "'" + bag.string() + "'");
  EXPECT_EQ(told.status, 0) << told.errors;
  std::map<std::string, std::vector<json>> messages;
  std::istringstream lines(told.output);
  for (std::string line; std::getline(lines, line);) {
    const json one = json::parse(line);
    messages[one["topic"]].push_back(one);
  }
  return messages;
}

void expect_joints(const json& message, const std::map<std::string, std::string>& row) {
  EXPECT_EQ(message["name"].size(), row.size() - 2);
  for (std::size_t i = 0; i < message["name"].size(); ++i)
    EXPECT_EQ(message["position"][i].get<double>(), std::stod(row.at(message["name"][i])));
}

void expect_truth(const json& pose, const json& target, std::map<std::string, std::string> row) {
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

TEST_F(SimulateBag, TheReferenceLibraryReadsWhatTheFolderHolds) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  const Scene& scene = scenes[0];
  const std::vector<std::string> options = {"--second-camera", "--joint-sigma", "0.001"};
  ASSERT_EQ(simulate(scene, "folder", options).status, 0);
  ASSERT_EQ(simulate(scene, "bag.mcap", options).status, 0);
  const auto messages = decoded(path("bag.mcap"));
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
      const json& stamp = all[i]["message"]["header"]["stamp"];
      EXPECT_EQ(stamp["sec"].get<std::int64_t>() * 1'000'000'000 + stamp["nanosec"].get<int>(),
                std::stoll(truth[i].at("stamp")));
    }
    const auto of = [&](const std::string& topic) { return messages.at(topic)[i]["message"]; };
    expect_joints(of("/joint_states"), joints.at(i));
    expect_joints(of("/truth/joint_states"), true_joints.at(i));
    expect_truth(of("/truth/parcel/pose"), of("/truth/targets")["targets"][0], truth[i]);
    const std::string file = digits(scene.first + i);
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

TEST_F(SimulateBag, RefusesBadOutput) {
  const auto refused = [&](const std::string& to, const std::string& words) {
    const Outcome outcome = simulate(scenes[0], to);
    EXPECT_EQ(outcome.status, 2) << to;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  refused("bag.db3", "bags are written as .mcap");
  refused("nowhere/bag.mcap", "No such file or directory");
  refused("/proc/bag.mcap", "cannot be written");
  EXPECT_TRUE(fs::is_empty(folder_.path()));

  write_file(path("mine.mcap"), "mine");
  refused("mine.mcap", "mine.mcap is there");
  EXPECT_EQ(read_file(path("mine.mcap")), "mine");
  fs::create_symlink("nowhere", path("link.mcap"));
  refused("link.mcap", "link.mcap is there");

  fs::create_directory(path("arm_description"));
  write_file(path("arm_description") / "arm.urdf", "<robot/>");
  refused("bag.mcap", "does not hold the simulated arm's meshes");
  EXPECT_EQ(read_file(path("arm_description") / "arm.urdf"), "<robot/>");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 3);
}

}  // namespace
}  // namespace penumbra::test
