// SPDX-License-Identifier: Apache-2.0
// Each command with each kind of input: it works, or refuses in one line that names the remedy.
#include "../web/viewer_process.hpp"
#include "fixtures.hpp"
#include "tiny_clouds.hpp"

#include <map>
#include <regex>
#include <set>

#include <io/cloud/cloud_file.hpp>
#include <io/dds/participant.hpp>
#include <io/files/pose_file.hpp>

namespace penumbra::test {
namespace {

constexpr std::size_t example_frames = 12;
constexpr double near = 0.003;  // metres; docs/calibration.md

/// Inputs by name, and the options that a command needs to take them.
const std::vector<std::pair<std::string, Words>> kinds = {
    {"recording", {}},
    {"without_depth", {}},
    {"clouds", {}},
    {"tf.mcap", {"--package"}},
    {"no_pose.mcap", {"--package", "--pose"}},
    {"no_depth.mcap", {"--package", "--no-depth"}},
    {"of_clouds/clouds.mcap", {}},
    {"results", {}},
    {"images", {}},
    {"recording/arm_description/arm.urdf", {}},
    {"notes.txt", {}},
    {"empty.mcap", {}},
    {"empty", {}},
    {"nowhere", {}},
};

constexpr std::size_t no_pose = 4;  // of them

const std::string works;
/// What commands on images make of recordings and bags, and all commands of other things.
const Words image_row = {works, works, "penumbra cloud", works, works, works, "penumbra cloud"};
const Words other_row = {"penumbra init", "*.mcap",         "*.mcap",
                         "is empty",      "recording.yaml", "No such file"};
/// By command: what it makes of each of `kinds`; a word of the remedy where it refuses the input.
const std::map<std::string, Words> table = {
    // recording, without depth, clouds; bag: tf, no pose, no depth, clouds; results, images, URDF;
    // text, empty file, empty folder, nothing
    {"run", image_row + Words{"penumbra view"} + other_row},
    {"view", image_row + Words{works} + other_row},
    {"tune", Words{works, "calibrate", "penumbra cloud", works, works, "calibrate",
                   "penumbra cloud", "penumbra view"} +
                 other_row},
    {"calibrate", image_row + Words{"penumbra view"} + other_row},
    {"view-planning", image_row + Words{"penumbra view"} + other_row},
    {"look-ahead", image_row + Words{"penumbra view"} + other_row},
    {"cloud", Words{"penumbra run", "penumbra run", works, "penumbra run", "penumbra run",
                    "penumbra run", works, "penumbra view"} +
                  other_row},
    {"play",
     {"*.mcap", "*.mcap", "*.mcap", works, works, works, works, "*.mcap", "*.mcap", "*.mcap",
      "*.mcap", "is empty", "*.mcap", "No such file"}},
    {"init",
     {"--force", "--force", "--force", "penumbra run", "penumbra run", "penumbra run",
      "penumbra cloud", "images", works, "images", "images", "is a bag", "images", "images"}},
    {"inspect",
     {"name a file", "name a file", "name a file", "right file", "XML", "XML", "XML", "name a file",
      "name a file", works, "XML", "XML", "name a file", "No such file"}},
};

class InputsTest : public FolderTest, public testing::WithParamInterface<std::string> {
 protected:
  InputsTest() {
    fs::copy(example, path("recording"), fs::copy_options::recursive);
    fs::copy(example, path("without_depth"), fs::copy_options::recursive);
    edit("without_depth/recording.yaml", "  depth: depth/%d.png", "  #");
    fs::copy(example, path("images"), fs::copy_options::recursive);
    fs::remove(path("images/recording.yaml"));
    write_clouds();
    write_bags();
    const bool needs_all = GetParam() == "run" || GetParam() == "view";
    succeed(penumbra(
        {"run", path("recording"), "-o", path("results"), "--frames", needs_all ? ":" : "0:1"}));
    write("notes.txt", "a text\n");
    write("empty.mcap", "");
    fs::create_directory(path("empty"));
  }

  void write_clouds() {
    for (const char* folder : {"clouds", "of_clouds"}) write_tiny_recording(path(folder));
    fs::create_directory(path("clouds/scans"));
    TinyBag bag = tiny_bag(path("of_clouds"));
    add_clouds(bag);
    std::erase_if(bag.messages, [](const auto& of) { return of.topic.starts_with("/camera/"); });
    bag.write_mcap(path("of_clouds/clouds.mcap"));
    for (int i = 0; i < 3; ++i)
      io::write_cloud(path("clouds/scans/" + std::to_string(i) + ".pcd"), FourPoints(i).message);
    write("clouds/recording.yaml", clouds_yaml());
  }

  void write_bags() {
    TinyBag bag = recording_bag(path("recording"), truth_);
    bag.write_mcap(path("tf.mcap"));
    TinyBag colored = bag;
    colored.remove("/camera/depth/image");
    colored.rename("/camera/depth/camera_info", "/camera/color/camera_info");
    colored.write_mcap(path("no_depth.mcap"));
    bag.remove("/camera/color/image");
    bag.remove("/tf_static");
    bag.write_mcap(path("no_pose.mcap"));
  }

  [[nodiscard]] bool is_bag(const std::string& kind) const { return kind.ends_with(".mcap"); }
  [[nodiscard]] Words masks_of(const std::string& kind) const {
    return {"--masks", is_bag(kind) ? "recording/truth/%d.png" : "truth/%d.png"};
  }
  [[nodiscard]] fs::path out(const std::string& kind) const {
    const bool is_file = GetParam() == "cloud" && is_bag(kind);
    return path("out_" + fs::path(kind).stem().string() + (is_file ? ".mcap" : ""));
  }

  [[nodiscard]] Words line(const std::string& kind, const Words& needed) const {
    const std::string& command = GetParam();
    const fs::path inputs = example / "..", targets = inputs / "view_planning/targets.yaml";
    Words words{command, path(kind)};
    if (command == "init" || command == "inspect")
      return kind == "results"
                 ? words
                 : words + Words{"--package",
                                 "arm_description=" + path("images/arm_description").string()};
    if (command == "play") return words + Words{"--rate", "100", "--delay", "0"};
    if (command != "view") words = words + Words{"-o", out(kind)};
    if (command == "calibrate" && (kind == "without_depth" || kind == "no_depth.mcap"))
      words = words + masks_of(kind);
    if (command == "view-planning")
      words = words +
              Words{"--targets", targets, "--candidates", inputs / "view_planning/candidates.csv"};
    if (command == "look-ahead")
      words =
          words + Words{"--targets", targets, "--trajectory", inputs / "look_ahead/sweep_left.csv"};
    const std::map<std::string, Words> options = {
        {"--package", example_package},
        {"--pose", {"--pose", example / "camera_pose.csv", "--parent", "base_link"}},
        {"--no-depth", {"--no-depth"}}};
    for (const std::string& option : needed)
      if (command != "cloud" || option != "--no-depth") words = words + options.at(option);
    return words;
  }

  void expect_works(const std::string& kind, const Words& words) {
    if (GetParam() == "view") return expect_view(kind, words);
    const Outcome outcome = succeed(penumbra(words, {"ROS_LOCALHOST_ONLY=1", "ROS_DOMAIN_ID=231"}));
    const std::map<std::string, std::function<void()>> checks = {
        {"run", [&] { expect_run(kind); }},
        {"tune", [&] { expect_same("tune.json", "fringe", kind); }},
        {"calibrate", [&] { expect_pose(kind); }},
        {"view-planning", [&] { expect_same("view_planning.json", "candidates", kind); }},
        {"look-ahead", [&] { expect_same("look_ahead.json", "motions", kind); }},
        {"cloud", [&] { expect_clouds(kind); }},
        {"play", [&] { expect_has(outcome.out, {"/joint_states"}); }},
        {"init", [&] { EXPECT_TRUE(fs::exists(path(kind) / "recording.yaml")); }},
        {"inspect", [&] { expect_has(outcome.out, {"forearm"}); }}};
    checks.at(GetParam())();
  }

  void expect_run(const std::string& kind) {
    const Json report = read_json(out(kind) / "report.json");
    const Json wanted = read_json(path("results/report.json"));
    ASSERT_EQ(report["frames"].size(), example_frames);
    for (std::size_t i = 0; i < example_frames; ++i) {
      EXPECT_EQ(report["frames"][i]["status"], "ok");
      EXPECT_EQ(report["frames"][i]["pixels"]["robot"], wanted["frames"][i]["pixels"]["robot"]);
    }
  }
  /// A key of the report is that of the recording.
  void expect_same(const std::string& file, const std::string& key, const std::string& kind) {
    const Json found = read_json(out(kind) / file);
    ASSERT_TRUE(found.contains(key)) << found;
    if (first_.is_null()) first_ = found[key];
    EXPECT_EQ(found[key], first_);
  }
  void expect_pose(const std::string& kind) {
    const Eigen::Isometry3d found = io::read_pose_csv(out(kind) / "camera_pose.csv");
    EXPECT_LT((found.translation() - truth_.translation()).norm(), near);
  }
  void expect_clouds(const std::string& kind) {
    if (!is_bag(kind))
      EXPECT_EQ(numbers_of(io::read_cloud(out(kind) / "clouds/0.pcd").cloud), (std::vector{1, 2}));
    else
      EXPECT_EQ(topic_counts(out(kind)).at("/penumbra/points"), 3U);
  }
  void expect_view(const std::string& kind, const Words& words) {
    const ViewerProcess viewer({words.begin() + 1, words.end()});
    ASSERT_NE(viewer.port(), 0) << kind;
    EXPECT_EQ(viewer.complete_session()["frames"], example_frames);
  }

  const Eigen::Isometry3d truth_ = io::read_pose_csv(example / "camera_pose.csv");
  Json first_;
};

TEST_P(InputsTest, WorkOrAreRefusedWithARemedy) {
  const Words& row = table.at(GetParam());
  ASSERT_EQ(row.size(), kinds.size()) << "an empty cell";
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const auto& [kind, options] = kinds[i];
    SCOPED_TRACE(GetParam() + " " + kind);
    const Words words = line(kind, options);
    if (row[i] == works)
      expect_works(kind, words);
    else
      expect_refused(penumbra(words), {path(kind).filename().string(), row[i]});
  }
  if (GetParam() == "calibrate")  // which alone takes masks
    for (const auto& [kind, options] : kinds)
      if (kind == "recording" || (is_bag(kind) && options.size() > 0 && kind != "no_depth.mcap")) {
        SCOPED_TRACE("masks of " + kind);
        expect_works(kind, line(kind, options) + masks_of(kind));
      }
  if (row[no_pose] != works || GetParam() == "play") return;
  expect_refused(penumbra(line(kinds[no_pose].first, {"--package"})),
                 {"no_pose.mcap", "no tf", "--pose and --parent"});
  expect_refused(penumbra(line(kinds[no_pose + 1].first, {"--package"})),
                 {"no_depth.mcap", "--no-depth", "but tune"});
}

INSTANTIATE_TEST_SUITE_P(Command, InputsTest, testing::ValuesIn([] {
                           Words commands;
                           for (const auto& [command, row] : table) commands.push_back(command);
                           return commands;
                         }()),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Inputs, EveryCommandThatTakesOneIsInTheTable) {
  std::set<std::string> known{"render", "doctor", "simulate", "topics", "live"};  // take none
  for (const auto& [command, row] : table) known.insert(command);
  const std::string help = penumbra({"--help"}).out;
  const std::regex command("\n  ([a-z][a-z-]*)  ");
  std::set<std::string> listed;
  for (std::sregex_iterator found(help.begin(), help.end(), command), end; found != end; ++found)
    listed.insert((*found)[1]);
  EXPECT_EQ(listed, known) << help;
}

}  // namespace
}  // namespace penumbra::test
