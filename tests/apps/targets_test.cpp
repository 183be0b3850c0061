// SPDX-License-Identifier: Apache-2.0
// `run` with targets, on the shipped recording against its truth (an independent ray caster's), and
// on a recording without depth images.
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

enum Truth : std::uint8_t { no_robot = 0, robot_seen = 1, before_robot = 2, robot_hides = 3 };

/// Pixels of a target of some hundred or thousand that silhouettes of tessellated meshes cover
/// otherwise than the exact shapes of the truth.
constexpr double silhouettes = 0.01;

/// Metres that the median of noisy depths (4 mm at 1 m, three times that at 1.8 m), and the wrist
/// as a network finds it, may lie off.
constexpr double depth_noise = 0.05;

const Json& target(const Json& report, int frame, const std::string& name) {
  for (const Json& one : report["frames"].at(static_cast<std::size_t>(frame))["targets"])
    if (one["name"] == name) return one;
  throw std::runtime_error("no target " + name);
}

/// The share of a pixel box for whose pixels the truth is not `value`.
double share_not(Truth value, int frame, int u0, int v0, int width, int height) {
  const auto truth = read_image<std::uint8_t>(example / "truth" / (std::to_string(frame) + ".png"));
  int count = 0;
  for (int v = v0; v < v0 + height; ++v)
    for (int u = u0; u < u0 + width; ++u) count += truth(u, v) != value ? 1 : 0;
  return count / (1.0 * width * height);
}

class RunTargetsTest : public FolderTest {
 protected:
  Outcome run(const Words& options = {}) const {
    return succeed(penumbra(Words{"run", example, "-o", out()} + options));
  }
  [[nodiscard]] fs::path targets(const std::string& list) const {
    write("targets.yaml", "targets:\n" + list);
    return path("targets.yaml");
  }
};

/// DESIGN section 4's keys, then what the report adds: what became of the estimate, the stamp that
/// was judged, the reason of an unknown verdict.
void expect_keys(const Json& json) {
  for (const Json& frame : json["frames"]) {
    EXPECT_GT(frame["timing_ms"]["targets"], 0.0);
    ASSERT_EQ(frame["targets"].size(), 4U);
    for (const Json& one : frame["targets"]) {
      EXPECT_EQ(
          keys(one),
          split("name covered inside occluded_fraction front_fraction clear_fraction "
                "unknown_fraction "
                "hidden_by_other_fraction measured_fraction seen_past_fraction verdict blame point "
                "point_pixels point_spread_m handled forecast estimate stamp_ns reason"));
      for (const Json& blame : one["blame"]) EXPECT_EQ(keys(blame), (Words{"link", "fraction"}));
      EXPECT_EQ(one["point"].is_null(), one["point_pixels"].is_null());
      EXPECT_EQ(one["point"].is_null(), one["point_spread_m"].is_null());
      EXPECT_EQ(one["handled"].is_null(), one["name"] == "cylinder") << "which is not handled";
      EXPECT_EQ(one["stamp_ns"], frame["stamp_ns"]);
      EXPECT_EQ(one["reason"].is_null(), one["verdict"] != "unknown");
      if (one["handled"].is_null()) continue;
      EXPECT_EQ(keys(one["handled"]),
                (Words{"source", "age_s", "position", "orientation", "sigma_m", "lost_in_s"}));
    }
  }
}

void expect_hidden_as_in_truth(const Json& json) {
  for (int frame = 0; frame < 12; ++frame) {
    if (frame == 9) continue;  // the gripper is about as far away as the cylinder
    const Json& cylinder = target(json, frame, "cylinder");
    EXPECT_NEAR(cylinder["occluded_fraction"].get<double>(),
                share_not(no_robot, frame, 460, 172, 38, 98), silhouettes)
        << "frame " << frame;
  }
  EXPECT_GT(target(json, 9, "cylinder")["unknown_fraction"], 0.05);
  EXPECT_EQ(target(json, 2, "cylinder")["blame"][0]["link"], "gripper");
  EXPECT_GT(target(json, 5, "cylinder")["hidden_by_other_fraction"], 0.3) << "the hand";
}

void expect_near(const Json& point, const Eigen::Vector3d& wanted) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(point.at(i).get<double>(), wanted[i], depth_noise) << i;
}

TEST_F(RunTargetsTest, TheRecordingsTargetsAreInTheReport) {
  const Outcome outcome = run();
  expect_has(outcome.out, {"target cylinder: 4 frames visible, 8 partial, 0 hidden",
                           "target lid: 4 frames visible, 2 partial, 4 hidden, 2 unknown, 0 out",
                           "\ntargets: median "});
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  expect_has(outcome.err, {"'lid'", "2 of 12", "frame 3"});
  const Json json = report();
  EXPECT_EQ(json["settings"]["targets"], (example / "targets.yaml").string());
  expect_keys(json);
  expect_hidden_as_in_truth(json);
  expect_lacks(read_file(out("report.json")), {": inf", ": nan", ": Inf", ": NaN"});

  // The lid's point is held while it is hidden, and comes back.
  const Json& hidden = target(json, 2, "lid");
  expect_values(hidden, {{"/verdict", "hidden"},
                         {"/occluded_fraction", 1.0},
                         {"/point", nullptr},
                         {"/estimate", "refused_verdict"},
                         {"/handled/source", "held"},
                         {"/handled/position", {0.42, 0.56, 0.30}},
                         {"/handled/orientation", nullptr}});
  EXPECT_NEAR(hidden["handled"]["age_s"].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(target(json, 1, "lid")["handled"]["source"], "measured");
  EXPECT_EQ(target(json, 6, "lid")["verdict"], "hidden") << "by the arm of a person";
  EXPECT_GT(target(json, 6, "lid")["hidden_by_other_fraction"], 0.9);
  EXPECT_EQ(target(json, 3, "lid")["verdict"], "unknown") << "what is not hidden is not measured";
  EXPECT_EQ(target(json, 9, "lid")["verdict"], "unknown") << "the gripper is about there";
  EXPECT_EQ(target(json, 11, "lid")["handled"]["source"], "measured");

  const Json& cube = target(json, 0, "cube");
  EXPECT_EQ(cube["verdict"], "visible");
  expect_near(cube["point"], {0.52, 0.28, 0.04});  // of its faces towards the camera
  const Json& wrist = target(json, 6, "wrist");
  EXPECT_EQ(wrist["verdict"], "visible") << "the hand stands before the arm";
  expect_near(wrist["handled"]["position"], {0.50, -0.34, 0.44});

  // What is not known is null: no number that JSON cannot hold, none that is made up.
  const Json& lost = target(json, 0, "wrist");
  EXPECT_EQ(lost["verdict"], "out_of_view");
  EXPECT_GT(lost["covered"], 0);
  EXPECT_EQ(lost["inside"], 0);
  for (const char* const share : {"occluded_fraction", "front_fraction", "clear_fraction",
                                  "unknown_fraction", "hidden_by_other_fraction", "point"})
    EXPECT_TRUE(lost[share].is_null()) << share;
  EXPECT_EQ(lost["handled"], (Json{{"source", "lost"},
                                   {"age_s", nullptr},
                                   {"position", nullptr},
                                   {"orientation", nullptr},
                                   {"sigma_m", nullptr},
                                   {"lost_in_s", nullptr}}));
}

TEST_F(RunTargetsTest, TheOptionComesBeforeTheRecording) {
  const fs::path file = targets("- {name: only, box: [465, 180, 24, 60]}\n");
  run({"--targets", file});
  const Json json = report();
  EXPECT_EQ(json["settings"]["targets"], file.string());
  ASSERT_EQ(json["frames"][2]["targets"].size(), 1U);
  const Json& only = target(json, 2, "only");
  EXPECT_EQ(only["verdict"], "hidden");
  EXPECT_NEAR(only["occluded_fraction"].get<double>() + only["unknown_fraction"].get<double>(),
              share_not(no_robot, 2, 465, 180, 24, 60), silhouettes);
  EXPECT_TRUE(only["hidden_by_other_fraction"].is_null()) << "no expected depth";
  EXPECT_EQ(target(json, 0, "only")["verdict"], "visible");
}

TEST_F(RunTargetsTest, TheOverlayShowsThem) {
  const auto overlay = [&](const Words& options) {
    run(Words{"--save", "overlay", "--frames", "2:3"} + options);
    return read_image<Rgb8>(out("overlay/000002.png"));
  };
  const Image<Rgb8> with = overlay({}), without = overlay({"--targets", targets("  []\n")});
  const auto differ = [&](int u, int v) { return !(with(u, v) == without(u, v)); };
  EXPECT_TRUE(differ(497, 200) || differ(498, 200)) << "the right edge of the cylinder's box";
  EXPECT_FALSE(differ(130, 355)) << "nothing is judged at the ball";
}

/// Frames that a csv leaves out have no target there; the run goes on and says so.
TEST_F(RunTargetsTest, FramesWithoutAKeypointAreUnknown) {
  write("k.csv", "frame,u,v\n0,230,350\n2,230,350\n");
  const fs::path file = targets("- {name: ball, keypoint: {csv: k.csv}, handling: point}\n");
  const Outcome outcome = run({"--targets", file, "--frames", "0:4"});
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  expect_has(outcome.err, {"'ball'", "2 of 4", "frame 1", "k.csv"});
  const Json json = report();
  const Json& gone = target(json, 1, "ball");
  EXPECT_EQ(gone["verdict"], "unknown");
  expect_has(gone["reason"], {"not found in frame 1"});
  for (const char* const key : {"covered", "inside", "occluded_fraction", "blame", "estimate"})
    EXPECT_TRUE(gone[key].is_null()) << key;
  EXPECT_EQ(gone["handled"]["source"], "held") << "handling goes on";
  EXPECT_EQ(target(json, 2, "ball")["verdict"], "visible");
}

/// Stamps of a detector that go back: each is judged on its own frame.
TEST_F(RunTargetsTest, LateStampsMayGoBack) {
  const auto row = [](int frame, int of) {
    return std::to_string(frame) + "," + std::to_string(1700000000000000000 + of * 100000000LL) +
           ",465,180,24,60\n";
  };
  write("b.csv", "frame,stamp,u,v,width,height\n" + row(2, 1) + row(3, 2) + row(4, 1) + row(5, 4) +
                     "11,7,465,180,24,60\n");
  run({"--targets", targets("- {name: part, box: {csv: b.csv}}\n")});
  const Json json = report();
  EXPECT_EQ(json["settings"]["target_history_s"], 0.5);
  EXPECT_EQ(target(json, 2, "part")["verdict"], "visible") << "in frame 1 it was";
  EXPECT_EQ(target(json, 3, "part")["verdict"], "hidden") << "in frame 2 it was";
  EXPECT_EQ(target(json, 4, "part")["verdict"], "visible") << "in frame 1 it was";
  EXPECT_EQ(target(json, 4, "part")["stamp_ns"], 1700000000100000000);
  EXPECT_EQ(target(json, 11, "part")["verdict"], "unknown");
  expect_has(target(json, 11, "part")["reason"], {"stamp"});
}

using WithoutDepthTest = TinyTest;

TEST_F(WithoutDepthTest, VerdictsAndMasksComeFromTheModel) {
  edit("recording.yaml", "  depth: depth_%d.png\n", "");
  write_targets(
      "- {name: behind, point: [0, 0, 1.5], radius: 0.05, link: base}\n"
      "- {name: before, point: [0, 0, 0.5], radius: 0.02, link: base}\n"
      "- {name: region, box: [28, 20, 6, 6]}\n");
  expect_has(succeed(run({"--save", "vdi,labels,robot_mask,overlay", "--targets",
                          path("targets.yaml"), "--report"}))
                 .err,
             {"no depth camera"});
  const Json all = report();
  ASSERT_EQ(all["frames"].size(), 3U);
  for (const Json& frame : all["frames"])
    expect_values(frame, {{"/status", "ok"},
                          {"/pixels/unknown", frame["pixels"]["robot"]},
                          {"/targets/0/verdict", "hidden"},
                          {"/targets/0/blame/0/link", "board"},
                          {"/targets/1/verdict", "visible"},
                          {"/targets/2/verdict", "unknown"}});
  for (const std::size_t frame : {0U, 2U}) {
    const auto mask = read_image<std::uint8_t>(out("robot_mask") / numbered(frame));
    const Image<std::uint8_t> label = labels(frame);
    for (std::size_t i = 0; i < mask.size(); ++i)
      ASSERT_EQ(mask.data()[i] == 255, label.data()[i] == 3);
  }
  EXPECT_TRUE(fs::exists(out("overlay/000000.png")));
  EXPECT_TRUE(fs::exists(out("report.html")));

  edit("recording.yaml", "  color: color_%d.png\n", "");  // no images at all
  succeed(run({"--save", "robot_mask"}));
  EXPECT_EQ(report()["frames"].size(), 3U);
}

using BagWithoutDepth = BagTest;

TEST_F(BagWithoutDepth, IsJudgedByItsColourImages) {
  bag_.remove(depth_topic);
  bag_.rename(info_topic, "/camera/color/camera_info");
  saves_ = "robot_mask,overlay";
  succeed(penumbra({"run", path(), "-o", path("wanted"), "--save", "robot_mask"}));
  for (const Words& options : {Words{}, {"--color-topic", color_topic}}) {
    const Outcome outcome = succeed(run(options + Words{"--no-depth"}));
    expect_has(outcome.out + outcome.err, {"no depth camera", "color: /camera/color/image_raw"});
    EXPECT_EQ(statuses(), (Words{"ok", "ok", "ok"}));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(read_file(out("robot_mask") / numbered(i)) ==
                  read_file(path("wanted/robot_mask") / numbered(i)))
          << i;
      EXPECT_TRUE(fs::exists(out("overlay") / numbered(i)));
    }
  }
  expect_failed(
      penumbra({"calibrate", tiny_mcap(), "-o", path("calibrated"), "--no-depth", "--search"}),
      {"--no-depth", "compares depth images"});
}

}  // namespace
}  // namespace penumbra::test
