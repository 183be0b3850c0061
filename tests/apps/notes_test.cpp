// SPDX-License-Identifier: Apache-2.0
// What run and render say of input that is understood, but looks wrong.
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

class NotesTest : public TinyTest {
 protected:
  /// Runs and expects this one note, on stderr and in the report; "": none.
  void expect_note_of_run(const std::string& words, int status = 0) {
    const Outcome outcome = run();
    const Json summary = report()["summary"];
    expect_note(outcome, summary["notes"], words, status);
    EXPECT_EQ(summary["bad_frames"], 0);
  }

  /// The same of render.
  void expect_note_of_render(Words options, const std::string& words) {
    options.emplace_back("--json");
    const Outcome outcome = render(options);
    expect_note(outcome, Json::parse(outcome.out)["notes"], words);
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
    EXPECT_NE(notes[0].get<std::string>().find(words), std::string::npos) << notes;
    EXPECT_EQ(outcome.err, "penumbra: note: " + notes[0].get<std::string>() + "\n");
  }
};

TEST_F(NotesTest, TextsOfFilesControlNoTerminal) {
  const std::string type = "\033[31m\r\302\233K\177";  // C0, C1 and DEL
  const std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': (48, 64)}\n";
  std::string npy = std::string("\x93NUMPY\1\0", 8);
  npy += {static_cast<char>(header.size()), '\0'};
  for (int i = 0; i < 3; ++i) write_file(path("depth_" + std::to_string(i) + ".npy"), npy + header);
  edit_file(path("recording.yaml"), "depth_%d.png", "depth_%d.npy");
  const auto expect_plain = [](const Outcome& outcome) {
    expect_has(outcome.err, {"depth_0.npy", "[31m"});
    for (const char c : std::string("\033\r\233\177"))
      EXPECT_EQ(outcome.err.find(c), std::string::npos) << outcome.err;
  };
  expect_plain(run());
  expect_plain(penumbra_interrupted({"view", path(), "--port", "0"}, [](const Outcome& printed) {
    return printed.err.find(".npy") != std::string::npos;
  }));
}

TEST_F(NotesTest, ARobotThatIsNeverInView) {
  const auto camera_at = [&](const std::string& z) {
    write_file(path("camera_pose.csv"), "1,0,0,0\n0,1,0,0\n0,0,1," + z + "\n0,0,0,1\n");
  };
  camera_at("0");
  expect_note_of_run("");
  expect_note_of_render({}, "");
  camera_at("2");  // the inverse: the robot is behind the camera
  expect_note_of_run("the robot is in no frame", 2);
  expect_note_of_render({}, "the robot is not in the image");
  camera_at("-2000");  // millimetres
  expect_note_of_run("the robot is in no frame", 2);
}

TEST_F(NotesTest, ACameraPoseThatDoesNotFitTheDepth) {
  write_file(path("camera_pose.csv"), "1,0,0,0\n0,1,0,0\n0,0,1,-2\n0,0,0,1\n");
  expect_note_of_run("camera's pose");
  expect_note_of_render({}, "");
}

TEST_F(NotesTest, RawPixelsThatTheLensModelDoesNotReach) {
  edit_file(path("camera_info.yaml"), "d: [0.0,", "d: [-0.6,");
  expect_note_of_run("the lens model does not reach ");
  expect_note_of_render({}, "the lens model does not reach ");
  const Outcome ran = run();
  expect_has(ran.out, {" uncovered pixels"});
  const Outcome rendered = render({"--json"});
  EXPECT_GT(Json::parse(rendered.out)["uncovered"], 0) << rendered.out;
}

TEST_F(NotesTest, LinksThatAreTiny) {
  edit_file(path("tiny.urdf"), "</robot>",
            "<link name=\"speck\"><collision><geometry><mesh filename=\"board.stl\" scale=\"0.001 "
            "0.001 0.001\"/></geometry></collision></link><joint name=\"hold\" "
            "type=\"fixed\"><parent link=\"board\"/><child link=\"speck\"/></joint></robot>");
  const std::string words = "link 'speck': its geometry is only 0.4 mm large; check the unit";
  expect_note_of_run(words);
  expect_note_of_render({}, words);
  EXPECT_NE(inspect().out.find("note: " + words), std::string::npos);
}

TEST_F(NotesTest, PartsBeforeTheNearPlane) {
  edit_file(path("tiny.urdf"), "</robot>",
            "<link name=\"plate\"><collision><geometry><box size=\"1 1 0.002\"/></geometry>"
            "</collision></link><joint name=\"hold\" type=\"fixed\"><parent link=\"base\"/><child "
            "link=\"plate\"/><origin xyz=\"0 0 0.005\"/></joint></robot>");
  const std::string words = "part of link 'plate' lies within 1 cm of the camera and is not drawn ";
  expect_note_of_run(words + "in 3 frames");
  expect_note_of_render({}, words + "in 1 frame");
  edit_file(path("tiny.urdf"), "0 0 0.005", "0 0 -0.005");
  expect_note_of_run("");
}

TEST_F(NotesTest, StampsOfAnotherUnit) {
  write_file(path("joint_states.csv"),
             "frame,stamp,slide\n0,1700000000000000,0\n"
             "1,1700000000033333,0.05\n2,1700000000066667,0.1\n");
  expect_note_of_run("are stamps in nanoseconds?");
}

TEST_F(NotesTest, StampsThatDoNotRise) {
  write_file(path("joint_states.csv"), "frame,stamp,slide\n0,7,0.0\n1,7,0.05\n2,6,0.1\n");
  expect_note_of_run("2 stamps not after the frame's before, first in frame 1");
}

TEST_F(NotesTest, JointsBeyondTheirLimits) {
  write_file(path("joint_states.csv"), "frame,slide\n0,0.0\n1,1.5\n2,2.5\n");
  expect_note_of_run("joint 'slide' beyond its limits in 2 frames");
  expect_note_of_render({"--joint", "slide=1.5"}, "joint 'slide' beyond its limits in 1 frame");
}

TEST_F(NotesTest, JointsThatRenderWasNotGiven) {
  edit_file(path("tiny.urdf"), "</robot>",
            "<link name=\"hand\"/><link name=\"tip\"/>"
            "<joint name=\"wrist\" type=\"continuous\"><parent link=\"board\"/><child "
            "link=\"hand\"/></joint><joint name=\"finger\" type=\"continuous\"><parent "
            "link=\"hand\"/><child link=\"tip\"/></joint></robot>");
  expect_note_of_render({"--joint", "slide=0.1"},
                        "no --joint for wrist, finger: drawn at rest (0, or no rotation)");
  expect_note_of_render({}, "");
  expect_note_of_render({"--joint", "slide=0", "--joint", "wrist=0", "--joint", "finger=1"}, "");
}

}  // namespace
}  // namespace penumbra::test
