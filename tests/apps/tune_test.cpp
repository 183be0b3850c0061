// SPDX-License-Identifier: Apache-2.0
// penumbra tune on a real recording, on a robot that lacks parts, and on what it must refuse.
#include "../support/cloud_measure.hpp"
#include "../support/data.hpp"
#include "fixtures.hpp"

#include <algorithm>
#include <cmath>
#include <regex>

#include <Eigen/Geometry>

#include <penumbra/labels/labels.hpp>

#include <io/files/npy.hpp>

namespace penumbra::test {
namespace {

constexpr int recorded_frames = 10;

/// Percentage points by which the share that tune states may differ from the one measured in the
/// results of `run`: tune counts all rows next to moving links, the measure the rows above the
/// table.
constexpr double same_percent = 0.03;

/// The real recording with a URDF of its own, from which links lose their geometry.
class TuneTest : public testing::Test {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_DATA();
    copy_recording("xarm7_realsense");
  }

  void copy_recording(const std::string& name) {
    fs::remove_all(path("recording"));
    fs::remove(path("xarm7.urdf"));
    fs::copy(data_folder() / name, path("recording"), fs::copy_options::recursive);
    const fs::path robots = fs::absolute(data_folder() / "robots/xarm7");
    fs::copy(robots / "xarm7.urdf", path("xarm7.urdf"));
    edit_file(path("recording/recording.yaml"), "../robots/xarm7/xarm7.urdf", path("xarm7.urdf"));
    edit_file(path("recording/recording.yaml"), "../robots/xarm7/xarm_description",
              robots / "xarm_description");
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  void strip(const std::string& link) {
    const std::regex geometry("<(visual|collision)[^]*?</(visual|collision)>");
    std::string urdf = read_file(path("xarm7.urdf"));
    const std::size_t begin = urdf.find("<link name=\"" + link + "\"");
    const std::size_t end = urdf.find("</link>", begin);
    ASSERT_NE(end, std::string::npos);
    urdf.replace(begin, end - begin,
                 std::regex_replace(urdf.substr(begin, end - begin), geometry, ""));
    write_file(path("xarm7.urdf"), urdf);
  }

  [[nodiscard]] Json tune(const std::string& input = "recording") {
    outcome_ = penumbra({"tune", path(input), "-o", path("tuned")});
    EXPECT_EQ(outcome_.status, 0) << outcome_.err;
    if (outcome_.status != 0) return {};
    return Json::parse(read_file(path("tuned/tune.json")));
  }

  Outcome run(const std::string& out, std::vector<std::string> options) {
    options.insert(options.begin(), {"run", path("recording"), "-o", path(out)});
    Outcome outcome = penumbra(options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  }

  /// Returns the percentage of the arm's points that are left by `run` with these options.
  [[nodiscard]] double percent_left(int frames, int air_rows, Words options) {
    options.insert(options.end(), {"--save", "vdi,labels"});
    run("left", options);
    Leftover sum;
    for (int i = 0; i < frames; ++i) {
      const std::string name = "00000" + std::to_string(i);
      Image<float> robot;
      Image<std::uint8_t> labels;
      Image<std::uint16_t> measured;
      io::read_npy(path("left/vdi") / (name + ".npy"), robot).require();
      io::read_png(path("left/labels") / (name + ".png"), labels).require();
      io::read_png(path("recording/depth_" + std::to_string(i) + ".png"), measured).require();
      sum.add(robot.view(), measured.view(), labels.view(), nearest_robot(robot.view()), air_rows);
    }
    return sum.percent();
  }

  TemporaryFolder folder_;
  Outcome outcome_;
};

/// Returns the options that tune recommends, with or without its reach.
Words recommended(const Json& tuned, const fs::path& folder, bool has_reach) {
  const Json& abc = tuned["tolerance"]["abc"];
  Words options = {"--tolerance", abc[0].dump() + ",0," + abc[2].dump()};
  if (has_reach) options.insert(options.end(), {"--fringe-reach", tuned["fringe"]["reach"].dump()});
  for (const Json& extra : tuned["extra"])
    options.insert(options.end(), {"--extra", extra["link"].get<std::string>() + "=" +
                                                  (folder / extra["mesh"]).string()});
  return options;
}

double percent_said(const Json& tuned) {
  for (const Json& tried : tuned["fringe"]["left_over"])
    if (tried["reach"] == tuned["fringe"]["reach"]) return 100.0 * tried["share"].get<double>();
  return NAN;
}

double tolerance_at(const Json& tuned, double z) {
  const Json& abc = tuned["tolerance"]["abc"];
  return abc[0].get<double>() + abc[2].get<double>() * z * z;
}

TEST_F(TuneTest, FindsReachAndToleranceOfARealSense) {
  const Json tuned = tune();
  EXPECT_GE(tuned["fringe"]["reach"], 20);
  EXPECT_LE(tuned["fringe"]["reach"], 60);
  for (const double z : {0.8, 1.2})  // as far as the arm is
    EXPECT_NEAR(tolerance_at(tuned, z), Tolerance().at(z), 0.3 * Tolerance().at(z));
  EXPECT_EQ(tuned["extra"], Json::array()) << "this robot is as its URDF";
  EXPECT_TRUE(fs::exists(path("tuned/tune.png")));
  EXPECT_NE(outcome_.out.find("fringe_reach: " + tuned["fringe"]["reach"].dump()),
            std::string::npos);
}

TEST_F(TuneTest, StatesWhatRunLeavesAndNoMoreThanWithTheDefault) {
  struct Recorded {
    const char* name;
    int frames, air_rows;  // the table begins below
    bool has_tool;         // link7, which the URDF then lacks
  };
  for (const Recorded& of :
       {Recorded{"xarm7_realsense", 10, 420, false}, Recorded{"xarm7_realsense_2", 5, 320, false},
        Recorded{"xarm7_realsense", 10, 420, true}}) {
    copy_recording(of.name);
    if (of.has_tool) strip("link7");
    const Json tuned = tune();
    const double left =
        percent_left(of.frames, of.air_rows, recommended(tuned, path("tuned"), true));
    EXPECT_NEAR(percent_said(tuned), left, same_percent) << of.name;
    EXPECT_LE(left, percent_left(of.frames, of.air_rows, recommended(tuned, path("tuned"), false)))
        << of.name;
  }
}

TEST_F(TuneTest, TakesBagsAndDepthWithoutColour) {
  edit_file(path("recording/recording.yaml"), "  color: color_%d.png", "");
  const Json tuned = tune();
  outcome_ =
      penumbra({"tune", path("recording/xarm7.mcap"), "-o", path("of_bag"), "--package",
                "xarm_description=" + (data_folder() / "robots/xarm7/xarm_description").string()});
  EXPECT_EQ(outcome_.status, 0) << outcome_.err;
  EXPECT_EQ(Json::parse(read_file(path("of_bag/tune.json")))["fringe"]["reach"],
            tuned["fringe"]["reach"]);
}

/// Of the pixels that showed the links by the whole URDF, how many are robot in `labels`.
double covered_share(const fs::path& whole, const fs::path& labels, std::vector<int> links) {
  std::size_t all = 0, covered = 0;
  for (int i = 0; i < recorded_frames; ++i) {
    const std::string file = "00000" + std::to_string(i) + ".png";
    Image<std::uint16_t> shown;
    Image<std::uint8_t> label;
    io::read_png(whole / "links" / file, shown).require();
    io::read_png(labels / "labels" / file, label).require();
    for (std::size_t p = 0; p < shown.size(); ++p) {
      if (std::find(links.begin(), links.end(), shown.data()[p]) == links.end()) continue;
      ++all;
      const auto value = static_cast<Label>(label.data()[p]);
      if (value != Label::clear && value != Label::fringe) ++covered;
    }
  }
  return static_cast<double>(covered) / static_cast<double>(all);
}

// The camera sees the flange, link7's end at z = 0, from outside, and its sides from all around.
TEST_F(TuneTest, FindsWhatTheUrdfLacks) {
  const std::string note = "something large moves with link";
  EXPECT_EQ(run("whole", {"--save", "links"}).err.find(note), std::string::npos);
  const std::vector<int> lacking = {7, 8};  // link6 and link7, as they stand in link images
  for (const char* link : {"link6", "link7"}) strip(link);
  const Json tuned = tune();
  Eigen::AlignedBox3d box;
  std::vector<std::string> options = {"--save", "labels"};
  for (const Json& extra : tuned["extra"]) {
    const std::string link = extra["link"];
    options.insert(options.end(),
                   {"--extra", link + "=" + path("tuned/extra_" + link + ".stl").string()});
    if (link != "link7") continue;
    for (const Json& piece : extra["boxes_m"])
      for (const char* end : {"min", "max"})
        box.extend(Eigen::Vector3d(piece[end][0], piece[end][1], piece[end][2]));
  }
  ASSERT_FALSE(box.isEmpty()) << outcome_.out;
  EXPECT_NEAR(box.max().z(), 0.0, 0.02);
  EXPECT_NEAR(box.max().x(), 0.037, 0.02);
  EXPECT_NEAR(box.min().x(), -0.037, 0.02);

  EXPECT_NE(run("without", {"--save", "labels"}).err.find(note + " 'link5'"), std::string::npos);
  EXPECT_LT(covered_share(path("whole"), path("without"), lacking), 0.5);
  EXPECT_EQ(run("with", options).err.find(note), std::string::npos);
  EXPECT_GT(covered_share(path("whole"), path("with"), lacking), 0.8);

  edit_file(path("recording/recording.yaml"),
            "camera:", "  extra: [{link: link7, mesh: ../tuned/extra_link7.stl}]\ncamera:");
  EXPECT_NE(run("by_key", {}).out.find("10 frames, 0 bad"), std::string::npos);
}

TEST(Tune, RefusesWithOneLine) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  fs::create_directory(path("empty"));
  fs::create_directory(path("tiny"));
  write_tiny_recording(path("tiny"));
  fs::create_directory(path("blind"));
  write_tiny_recording(path("blind"));
  for (const char* file : {"depth_0.png", "depth_1.png", "depth_2.png"})
    fs::remove(fs::path(path("blind")) / file);
  write_file(path("file"), "");
  const std::vector<std::pair<std::vector<std::string>, std::string>> lines = {
      {{path("nowhere"), "-o", path("out")}, "nowhere"},
      {{path("empty"), "-o", path("out")}, "empty"},
      {{path("blind"), "-o", path("out")}, "depth_0.png"},
      {{path("tiny"), "-o", path("out"), "--frames", "0:1"}, "the arm does not move"},
      {{path("tiny"), "-o", path("file")}, "file"},
      {{path("tiny"), "-o", "/proc/penumbra"}, "/proc"},
      {{path("tiny")}, "--output"}};
  for (auto [line, word] : lines) {
    line.insert(line.begin(), "tune");
    const Outcome outcome = penumbra(line);
    EXPECT_EQ(outcome.status, 2) << testing::PrintToString(line) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in: " << outcome.err;
  }
}

TEST(Extra, IsDrawnWithItsLinkAndNamedInErrors) {
  const TemporaryFolder folder;
  write_tiny_recording(folder.path());
  const auto run = [&](const std::string& extra) {
    return penumbra({"run", folder.path(), "-o", folder.path() / "out", "--extra", extra});
  };
  const std::string tool = folder.write("tool.stl",
                                        "solid t\nfacet normal 0 0 1\nouter loop\n"
                                        "vertex 0 0 0.8\nvertex 0.1 0 0.8\nvertex 0 0.1 0.8\n"
                                        "endloop\nendfacet\nendsolid t\n");
  EXPECT_EQ(run("base=" + tool).status, 0) << "a link without geometry of its own";
  const Json report = Json::parse(read_file(folder.path() / "out/report.json"));
  EXPECT_EQ(report["settings"]["extra"][0]["link"], "base");
  for (const auto& [extra, word] : std::vector<std::pair<std::string, std::string>>{
           {"bord=" + tool, "\"bord\" is no link"},
           {"board=" + (folder.path() / "tiny.urdf").string(), "tiny.urdf"},
           {"board", "LINK=FILE"}}) {
    const Outcome outcome = run(extra);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace penumbra::test
