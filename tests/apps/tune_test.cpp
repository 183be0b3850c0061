// SPDX-License-Identifier: Apache-2.0
// penumbra tune on a real recording, on a robot that lacks parts, and on what it must refuse.
#include "../support/cloud_measure.hpp"
#include "real_recording.hpp"

#include <algorithm>
#include <cmath>

#include <penumbra/labels/labels.hpp>

namespace penumbra::test {
namespace {

constexpr std::size_t recorded_frames = 10;

/// Percentage points by which the share that tune states may differ from the one measured in the
/// results of `run`: tune counts all rows next to moving links, the measure the rows above the
/// table.
constexpr double same_percent = 0.03;

/// The real recording, from whose URDF links lose their geometry.
class TuneTest : public RealRecording {
 protected:
  void strip(const std::string& link) {
    const std::regex geometry("<(visual|collision)[^]*?</(visual|collision)>");
    std::string urdf = read_file(path("recording/xarm7.urdf"));
    const std::size_t begin = urdf.find("<link name=\"" + link + "\"");
    const std::size_t end = urdf.find("</link>", begin);
    ASSERT_NE(end, std::string::npos);
    urdf.replace(begin, end - begin,
                 std::regex_replace(urdf.substr(begin, end - begin), geometry, ""));
    write("recording/xarm7.urdf", urdf);
  }

  [[nodiscard]] Json tune() {
    out_ = succeed(penumbra({"tune", path("recording"), "-o", path("tuned")})).out;
    return read_json(path("tuned/tune.json"));
  }

  /// Returns the percentage of the arm's points that are left by `run` with these options.
  [[nodiscard]] double percent_left(int frames, int air_rows, const Words& options) {
    succeed(run("left", options + Words{"--save", "vdi,labels"}));
    Leftover sum;
    for (int i = 0; i < frames; ++i) {
      const auto number = static_cast<std::size_t>(i);
      const auto robot = read_image<float>(path("left/vdi") / numbered(number, ".npy"));
      const auto labels = read_image<std::uint8_t>(path("left/labels") / numbered(number));
      const auto measured =
          read_image<std::uint16_t>(path("recording/depth_" + std::to_string(i) + ".png"));
      sum.add(robot.view(), measured.view(), labels.view(), nearest_robot(robot.view()), air_rows);
    }
    return sum.percent();
  }

  std::string out_;  // of tune
};

double percent_said(const Json& tuned) {
  for (const Json& tried : tuned["fringe"]["left_over"])
    if (tried["reach"] == tuned["fringe"]["reach"]) return 100.0 * tried["share"].get<double>();
  return NAN;
}

TEST_F(TuneTest, FindsReachAndToleranceOfARealSense) {
  const Json tuned = tune();
  EXPECT_GE(tuned["fringe"]["reach"], 20);
  EXPECT_LE(tuned["fringe"]["reach"], 60);
  const Json& abc = tuned["tolerance"]["abc"];
  for (const double z : {0.8, 1.2})  // as far as the arm is
    EXPECT_NEAR(abc[0].get<double>() + abc[2].get<double>() * z * z, Tolerance().at(z),
                0.3 * Tolerance().at(z));
  EXPECT_EQ(tuned["extra"], Json::array()) << "this robot is as its URDF";
  EXPECT_TRUE(fs::exists(path("tuned/tune.png")));
  expect_has(out_, {"fringe_reach: " + tuned["fringe"]["reach"].dump()});
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
    copy_real_recording(of.name, path("recording"));
    if (of.has_tool) strip("link7");
    const Json tuned = tune();
    const Json& abc = tuned["tolerance"]["abc"];
    Words options = {"--tolerance", abc[0].dump() + ",0," + abc[2].dump()};
    for (const Json& extra : tuned["extra"])
      options = options + Words{"--extra", extra["link"].get<std::string>() + "=" +
                                               (path("tuned") / extra["mesh"]).string()};
    const double by_default = percent_left(of.frames, of.air_rows, options);
    options = options + Words{"--fringe-reach", tuned["fringe"]["reach"].dump()};
    const double with_reach = percent_left(of.frames, of.air_rows, options);
    EXPECT_NEAR(percent_said(tuned), with_reach, same_percent) << of.name;
    EXPECT_LE(with_reach, by_default) << of.name;
  }
}

/// Of the pixels that showed the links by the whole URDF, how many are robot in `labels`.
double covered_share(const fs::path& whole, const fs::path& labels, std::vector<int> links) {
  std::size_t all = 0, covered = 0;
  for (std::size_t i = 0; i < recorded_frames; ++i) {
    const auto shown = read_image<std::uint16_t>(whole / "links" / numbered(i));
    const auto label = read_image<std::uint8_t>(labels / "labels" / numbered(i));
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
  expect_lacks(succeed(run("whole", {"--save", "links"})).err, {note});
  const std::vector<int> lacking = {7, 8};  // link6 and link7, as they stand in link images
  for (const char* link : {"link6", "link7"}) strip(link);
  const Json tuned = tune();
  Eigen::AlignedBox3d box;
  Words options = {"--save", "labels"};
  for (const Json& extra : tuned["extra"]) {
    const std::string link = extra["link"];
    options.insert(options.end(),
                   {"--extra", link + "=" + path("tuned/extra_" + link + ".stl").string()});
    if (link != "link7") continue;
    for (const Json& piece : extra["boxes_m"])
      for (const char* end : {"min", "max"})
        box.extend(Eigen::Vector3d(piece[end][0], piece[end][1], piece[end][2]));
  }
  ASSERT_FALSE(box.isEmpty()) << out_;
  EXPECT_NEAR(box.max().z(), 0.0, 0.02);
  EXPECT_NEAR(box.max().x(), 0.037, 0.02);
  EXPECT_NEAR(box.min().x(), -0.037, 0.02);

  expect_has(succeed(run("without", {"--save", "labels"})).err, {note + " 'link5'"});
  EXPECT_LT(covered_share(path("whole"), path("without"), lacking), 0.5);
  expect_lacks(succeed(run("with", options)).err, {note});
  EXPECT_GT(covered_share(path("whole"), path("with"), lacking), 0.8);

  edit("recording/recording.yaml",
       "camera:", "  extra: [{link: link7, mesh: ../tuned/extra_link7.stl}]\ncamera:");
  expect_has(succeed(run("by_key")).out, {"10 frames, 0 bad"});
}

using Tune = TinyTest;

TEST_F(Tune, RefusesWithOneLine) {
  expect_all_refused(
      [](const Words& line) { return penumbra(Words{"tune"} + line); },
      {{{path(), "-o", out(), "--frames", "0:1"}, "different poses"}, {{path()}, "--output"}});
}

using Extra = TinyTest;

TEST_F(Extra, IsDrawnWithItsLinkAndNamedInErrors) {
  const std::string tool = path("tool.stl");
  write_file(tool,
             "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.8\nvertex 0.1 0 0.8\n"
             "vertex 0 0.1 0.8\nendloop\nendfacet\nendsolid t\n");
  succeed(run({"--extra", "base=" + tool}));  // a link without geometry of its own
  EXPECT_EQ(report()["settings"]["extra"][0]["link"], "base");
  expect_all_refused(
      [this](const Words& extra) {
        return run({"--extra", extra[0]});
      },
      {{{"bord=" + tool}, "\"bord\" is no link"},
       {{"board=" + path("tiny.urdf").string()}, "tiny.urdf"},
       {{"board"}, "LINK=FILE"}});
}

}  // namespace
}  // namespace penumbra::test
