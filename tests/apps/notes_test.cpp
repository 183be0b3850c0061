// SPDX-License-Identifier: Apache-2.0
// What run and render say of input that is understood, but looks wrong, and of links without a
// mesh.
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

class NotesTest : public TinyTest {
 protected:
  /// Runs and expects this one note, on stderr and in the report; "": none.
  void expect_note_of_run(const std::string& words, int status = 0) {
    const Outcome outcome = run();
    expect_note(outcome, report()["summary"]["notes"], words, status);
    EXPECT_EQ(report()["summary"]["bad_frames"], 0);
  }
  void expect_note_of_render(const Words& options, const std::string& words) {
    const Outcome outcome = render(options + Words{"--json"});
    expect_note(outcome, Json::parse(outcome.out)["notes"], words);
  }
  void expect_note_of_both(const std::string& words) {
    expect_note_of_run(words);
    expect_note_of_render({}, words);
  }
  void put_camera_at(const std::string& z) const {
    write("camera_pose.csv", "1,0,0,0\n0,1,0,0\n0,0,1," + z + "\n0,0,0,1\n");
  }

 private:
  static void expect_note(const Outcome& outcome, const Json& notes, const std::string& words,
                          int status = 0) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    if (words.empty()) {
      EXPECT_EQ(outcome.err, "");
      EXPECT_EQ(notes, Json::array());
      return;
    }
    ASSERT_EQ(notes.size(), 1U) << notes;
    expect_has(notes[0], {words});
    EXPECT_EQ(outcome.err, "penumbra: note: " + notes[0].get<std::string>() + "\n");
  }
};

TEST_F(NotesTest, ARobotThatIsNeverInViewAndACameraPoseThatDoesNotFitTheDepth) {
  put_camera_at("0");
  expect_note_of_both("");
  put_camera_at("2");  // the inverse: the robot is behind the camera
  expect_note_of_run("the robot is in no frame", 2);
  EXPECT_EQ(report()["summary"]["shows_robot"], false);
  expect_note_of_render({}, "the robot is not in the image");
  put_camera_at("-2000");  // millimetres
  expect_note_of_run("the robot is in no frame", 2);
  put_camera_at("-2");
  expect_note_of_run("camera's pose");
  EXPECT_EQ(report()["summary"]["shows_robot"], true);
  expect_note_of_render({}, "");
}

TEST_F(NotesTest, RawPixelsThatTheLensModelDoesNotReach) {
  edit("camera_info.yaml", "d: [0.0,", "d: [-0.6,");
  expect_note_of_both("the lens model does not reach ");
  expect_has(run().out, {" uncovered pixels"});
  EXPECT_GT(Json::parse(render({"--json"}).out)["uncovered"], 0);
}

TEST_F(NotesTest, LinksThatAreTiny) {
  add_to_robot(fixed_link("speck", "board", R"(<collision><geometry><mesh filename="board.stl"
      scale="0.001 0.001 0.001"/></geometry></collision>)"));
  const std::string words = "link 'speck': its geometry is only 0.4 mm large; check the unit";
  expect_note_of_both(words);
  expect_has(inspect().out, {"note: " + words});
}

TEST_F(NotesTest, OriginsInMillimetresAndDegrees) {
  add_to_robot(fixed_link("speck", "board", R"(<collision><origin xyz="0 0 380"/><geometry>
      <box size="0.1 0.1 0.1"/></geometry></collision>)"));
  expect_note_of_run("380 m away: is it in millimetres?");
}

TEST_F(NotesTest, PartsBeforeTheNearPlane) {
  add_to_robot(fixed_link("plate", "base", R"(<collision><origin xyz="0 0 0.005"/><geometry>
      <box size="1 1 0.002"/></geometry></collision>)"));
  const std::string words = "part of link 'plate' lies within 1 cm of the camera and is not drawn ";
  expect_note_of_run(words + "in 3 frames");
  expect_note_of_render({}, words + "in 1 frame");
  edit("tiny.urdf", "0 0 0.005", "0 0 -0.005");
  expect_note_of_run("");
}

TEST_F(NotesTest, StampsOfAnotherUnitOrThatDoNotRise) {
  write_joints(
      "frame,stamp,slide\n0,1700000000000000,0\n"
      "1,1700000000033333,0.05\n2,1700000000066667,0.1\n");
  expect_note_of_run("are stamps in nanoseconds?");
  write_joints("frame,stamp,slide\n0,7,0.0\n1,7,0.05\n2,6,0.1\n");
  expect_note_of_run("2 stamps not after the frame's before, first in frame 1");
}

TEST_F(NotesTest, JointsBeyondTheirLimits) {
  write_joints("frame,slide\n0,0.0\n1,1.5\n2,2.5\n");
  expect_note_of_run("joint 'slide' beyond its limits in 2 frames");
  expect_note_of_render({"--joint", "slide=1.5"}, "joint 'slide' beyond its limits in 1 frame");
}

TEST_F(NotesTest, JointsThatRenderWasNotGiven) {
  add_to_robot(
      R"(<link name="hand"/><link name="tip"/>
         <joint name="wrist" type="continuous"><parent link="board"/><child link="hand"/></joint>
         <joint name="finger" type="continuous"><parent link="hand"/><child link="tip"/></joint>)");
  expect_note_of_render({"--joint", "slide=0.1"},
                        "no --joint for wrist, finger: drawn at rest (0, or no rotation)");
  expect_note_of_render({}, "");
  expect_note_of_render({"--joint", "slide=0", "--joint", "wrist=0", "--joint", "finger=1"}, "");
}

TEST_F(NotesTest, AttachedBodiesAndTargetsInMillimetres) {
  const std::string whole = read_file(path("recording.yaml")) + "targets: targets.yaml\n";
  std::string reason;  // of the target's verdict
  const auto expect_note_of = [&](const std::string& body, const std::string& target,
                                  const std::string& words) {
    SCOPED_TRACE(body + target);
    write_file(
        path("recording.yaml"),
        whole + (body.empty() ? "" : "attached: [{name: part, link: board, " + body + "}]\n"));
    write_targets("- {name: cup, " + target + "}\n");
    succeed(run());
    const Json of_cup = report()["frames"][0]["targets"][0];
    reason = of_cup["verdict"] == "unknown" ? of_cup["reason"] : "";
    const Json notes = report()["summary"]["notes"];
    ASSERT_EQ(notes.size(), words.empty() ? 0U : 1U) << notes;
    expect_has(notes.dump(), {words});
  };
  const std::string cup = "point: [0.3, 0.2, 2], radius: 0.03";
  expect_note_of("", cup, "");
  expect_note_of("box: [0.1, 0.05, 0.1]", cup, "");
  expect_note_of("box: [2, 0.05, 0.1], pose: [0, 0, -1.5, 0, 0, 0, 1]", cup, "");
  expect_note_of("box: [0.1, 0.05, 0.1], pose: [100, 50, 0, 0, 0, 0, 1]", cup,
                 "'part' reaches 112 m");
  expect_note_of("box: [100, 50, 100]", cup, "'part' reaches 75 m");
  const auto expect_reason_of = [&](const std::string& target, const std::string& words) {
    expect_note_of("", target, "");
    if (words.empty())
      EXPECT_EQ(reason.find("millimetres"), std::string::npos) << reason;
    else
      expect_has(reason, {words, "millimetres"});
  };
  // A truck in a hall, and far away.
  expect_reason_of("box3d: [0, 0, 30, 0, 0, 0, 1], size: [3, 4, 16]", "");
  expect_reason_of("point: [0, 0, 150], radius: 2", "");
  expect_reason_of("box: [10, 10, 8, 20], height: 1.8", "");
  expect_reason_of("point: [300, 200, 2000], radius: 30", "it is 2032 m away");
  expect_reason_of("point: [0.3, 0.2, 2], radius: 30", "it is 60 m large");
  expect_reason_of("box3d: [0, 0, 2, 0, 0, 0, 1], size: [80, 80, 120]", "it is 120 m large");
}

using LeniencyTest = TinyTest;

constexpr const char* ball =
    "<visual><origin xyz=\"0 0 2\"/><geometry><sphere radius=\"1\"/></geometry></visual>";

TEST_F(LeniencyTest, EveryResultNamesLinksWithoutTheirMesh) {
  add_to_robot(
      fixed_link("more", "base",
                 R"(<collision><geometry><mesh filename="nowhere.stl"/></geometry></collision>)"));
  for (const Outcome& outcome : {run(), render(), inspect()}) {
    EXPECT_EQ(outcome.status, 2);
    expect_has(outcome.err, {"nowhere.stl"});
  }
  const std::string allowed = "--allow-missing-meshes";

  expect_has(succeed(run({allowed})).err, {"missing_link in 3 of 3 frames", "'more'"});
  expect_values(report(),
                {{"/summary/missing_links", Json{"more"}}, {"/frames/0/status", "missing_link"}});
  expect_has(message(0), {"'more'"});

  const Outcome rendered = succeed(render({allowed, "--json"}));
  EXPECT_EQ(rendered.err, "penumbra: missing_link: no geometry of link 'more'\n");
  EXPECT_EQ(Json::parse(rendered.out)["missing_links"], Json{"more"});
  EXPECT_EQ(Json::parse(succeed(inspect({allowed, "--json"})).out)["links"][2]["missing"], true);
}

TEST_F(LeniencyTest, LinksWithoutCollisionGeometryAreDrawnWithANote) {
  add_to_robot(fixed_link("more", "base", ball));
  const std::string fallback = "--geometry-fallback";
  for (const Words& options : {Words{}, {fallback}, {"--geometry", "collision", fallback}}) {
    const bool is_default = options.empty();
    const std::string err = run(options).err;
    EXPECT_EQ(err.find("only visual: \"more\"") != std::string::npos, is_default) << err;
    expect_values(report()["settings"], {{"/geometry", "collision"}, {"/geometry_fallback", true}});
    const Json link = Json::parse(inspect(options + Words{"--json"}).out)["links"][2];
    EXPECT_EQ(link["drawn"], true);
    EXPECT_EQ(link["reason"], "visual, as it has no collision");
  }
}

TEST_F(LeniencyTest, LinksOfTheOtherGeometryAreNeverLeftOutInSilence) {
  add_to_robot(fixed_link("more", "base", ball));
  const Words strict = {"--geometry", "collision"};
  edit("recording.yaml", "tiny.urdf\n", "tiny.urdf\n  geometry: collision\n");
  for (const Outcome& outcome : {run(), run(strict), render(strict), inspect(strict)}) {
    EXPECT_EQ(outcome.status, 2);
    expect_has(outcome.err, {"1 link has no collision geometry, only visual: \"more\"",
                             "--geometry-fallback", "--geometry visual", "ignore_links"});
  }
  expect_has(succeed(run({"--allow-missing-meshes"})).err, {"missing_link in 3 of 3 frames"});
  EXPECT_EQ(report()["summary"]["missing_links"], Json{"more"});
  expect_has(notes(), {"only visual"});
}

}  // namespace
}  // namespace penumbra::test
