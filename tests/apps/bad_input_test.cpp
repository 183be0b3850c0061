// SPDX-License-Identifier: Apache-2.0
// Recordings, options and bags that `penumbra run` cannot take.
#include "fixtures.hpp"

namespace penumbra::test {
namespace {

using Spoil = std::function<void(const fs::path&)>;

/// What makes a recording faulty, and what the one line on stderr must name.
using BadInput = std::pair<Spoil, Words>;

Spoil edit(const char* file, const char* from, const char* to) {
  return [=](const fs::path& folder) { edit_file(folder / file, from, to); };
}
Spoil replace(const char* file, const std::string& content) {
  return [=](const fs::path& folder) { write_file(folder / file, content); };
}
Spoil take_away(const char* file) {
  return [=](const fs::path& folder) { fs::remove(folder / file); };
}

/// ASCII as a Windows editor saves it, with a byte order mark or without.
std::string utf16(const std::string& text, bool with_mark) {
  std::string bytes = with_mark ? "\xFF\xFE" : "";
  for (const char c : text) bytes.append({c, '\0'});
  return bytes;
}

void expect_inputs_refused(const std::vector<BadInput>& inputs) {
  for (const auto& [spoil, named] : inputs) {
    const TemporaryFolder folder;
    const fs::path recording = folder.path() / "recording";
    write_tiny_recording(recording);
    spoil(recording);
    expect_refused(penumbra({"run", recording, "-o", folder.path() / "out"}), named);
  }
}

using BadInputTest = TinyTest;

TEST(BadInput, Robots) {
  expect_inputs_refused({
      {take_away("tiny.urdf"), {"tiny.urdf"}},
      {replace("tiny.urdf", "<robot name=\"tiny\"><link name=\"base\">"), {"tiny.urdf"}},
      {replace("tiny.urdf", utf16("<robot name=\"tiny\"/>", true)), {"tiny.urdf", "UTF-8"}},
      {replace("tiny.urdf",
               "<robot name=\"tiny\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">"
               "<xacro:include filename=\"a.xacro\"/><link name=\"base\"/></robot>"),
       {"tiny.urdf", "xacro"}},
      {edit("tiny.urdf", "xyz=\"0 0 1\"", "xyz=\"0 nan 1\""), {"tiny.urdf", "nan"}},
      {edit("tiny.urdf",
            "<collision><geometry><mesh filename=\"board.stl\"/></geometry></collision>", ""),
       {"no link is rendered"}},
      {take_away("board.stl"), {"board"}},
  });
}

TEST(BadInput, Recordings) {
  const std::string pose = "1,0,0,0\n0,1,0,0\n0,0,1,0\n0,0,0,1\n";
  expect_inputs_refused({
      {edit("recording.yaml", "  parent:", "  perent:"), {"recording.yaml:", "perent"}},
      {edit("recording.yaml", "parent: base", "parent: bass"),
       {"recording.yaml", "camera.parent", "bass", "base, board"}},
      {edit("recording.yaml", "joints: joint_states.csv", "joints: ."), {"is a folder"}},
      {edit("recording.yaml", "  urdf: tiny.urdf", "  urdf: tiny.urdf\n  ignore_links: ['*']"),
       {"no link is rendered"}},
      {take_away("camera_info.yaml"), {"camera_info.yaml"}},
      {edit("camera_info.yaml", "d: [0.0", "d: [-1e9"), {"camera_info.yaml", "reaches no pixel"}},
      {replace("camera_pose.csv", utf16(pose, false)), {"camera_pose.csv: is UTF-16", "UTF-8"}},
  });
}

TEST(BadInput, Frames) {
  const auto swapped = [](const fs::path& folder) {
    edit_file(folder / "camera_info.yaml", "width: 64\nheight: 48", "width: 48\nheight: 64");
    edit_file(folder / "recording.yaml", "frames:", "targets: targets.yaml\nframes:");
    write_file(folder / "targets.yaml", "targets:\n  - {name: a, box: [9, 9, 9, 9]}\n");
  };
  const auto without_depth = [](const fs::path& folder) {
    for (const char* file : {"depth_0.png", "depth_1.png", "depth_2.png"})
      fs::remove(folder / file);
  };
  expect_inputs_refused({
      {take_away("joint_states.csv"), {"joint_states.csv"}},
      {replace("joint_states.csv", "frame,slide\n0,far\n1,near\n"), {"joint_states.csv", "far"}},
      {replace("joint_states.csv", std::string("frame,slide\n0,0.1\n\0", 19)),
       {"joint_states.csv:3", "'?'"}},
      {replace("joint_states.csv", "frame,slide\n0,0.1\xFF\x1B[31m\n"), {"'0.1??[31m'"}},
      {replace("joint_states.csv", utf16("frame,slide\n0,0.1\n", true)),
       {"joint_states.csv: is UTF-16", "UTF-8"}},
      {without_depth, {"missing_depth", "depth_0.png"}},
      {swapped, {"bad_depth in 3 of 3 frames", "48 x 64\n"}},
  });
}

TEST_F(BadInputTest, Targets) {
  write_targets("- name: a\n  box: [1, 2, 0, 4]\n");
  expect_refused(run({"--targets", path("targets.yaml")}), {"targets.yaml:3: targets[0].box"});
  edit("recording.yaml", "frames:", "targets: no.yaml\nframes:");
  expect_refused(run(), {"recording.yaml", "no.yaml"});
}

TEST_F(BadInputTest, Options) {
  expect_all_refused([this](const Words& options) { return run(options); },
                     {{{"--renderer", "auto"}, "cpu, gl, reference"},
                      {{"--geometry", "nice"}, "--geometry"},
                      {{"--tolerance", "0.1,0"}, "--tolerance"},
                      {{"--tolerance=-1,0,0"}, "-1"},
                      {{"--front-min-width", "64"}, "0 to 63"},
                      {{"--fringe-reach", "256"}, "--fringe-reach"},
                      {{"--sensor", "kinect"}, "kinect"},
                      {{"--labels", "half"}, "--labels"},
                      {{"--image", "cooked"}, "--image"},
                      {{"--save", "labels,video"}, "video"},
                      {{"--save", "points", "--points-frame", "hand"}, "'hand'"},
                      {{"--points-frame", "base"}, "--save points"},
                      {{"--threads", "0"}, "--threads"},
                      {{"--threads", "100000"}, "1 to 512"},
                      {{"--renderer", "reference", "--threads", "3"}, "--threads 3"},
                      {{"--renderer", "gl", "--threads", "2"}, "--threads 2"},
                      {{"--gl-device", "0"}, "--renderer gl"},
                      {{"--renderer", "gl", "--gl-device=-1"}, "--gl-device"},
                      {{"--targets", "t.yaml"}, "t.yaml"},
                      {{"--time-offset=-0.1"}, "--time-offset"},
                      {{"--frames", "1:4"}, "0 to 2"},
                      {{"--frames", "all"}, "--frames"},
                      {{"--speed"}, "(penumbra run --help lists the options)"},
                      {{"another"}, "another"}});
}

TEST(BadInput, CommandLines) {
  expect_all_refused(
      [](const Words& line) { return penumbra(line); },
      {{{}, "a command is needed"},
       {{"walk"}, "no such command"},
       {{"calibrat"}, "did you mean calibrate"},
       {{"init"}, "FOLDER"},
       {{"run"}, "INPUT"},
       {{"render"}, "--robot"},
       {{"inspect"}, "URDF"},
       {{"doctor", "--fast"}, "--fast"},
       {{"simulate", "belt", "-o", "out", "--rate", "0"}, "--rate"},
       {{"run", "x.mcap", "-o", "out", "--package", "name=nowhere"}, "a folder that exists"},
       {{"run", "x.mcap", "-o", "out", "--package", "n=/", "--package", "n=/tmp"}, "n=/tmp"},
       {{"run", "recording", "-o", ""}, "-o,--output"},
       {{"run", "", "-o", "out"}, "INPUT"},
       {{"inspect", ""}, "URDF"}});
}

class BadBagTest : public BagTest {
 protected:
  /// The tiny bag as it is after `spoil` is refused.
  void expect_spoilt(const std::function<void(TinyBag&)>& spoil, const Words& named) {
    const TinyBag sound = bag_;
    spoil(bag_);
    expect_refused(run(), named);
    bag_ = sound;
  }
  static auto without(const std::string& topic) {
    return [topic](TinyBag& bag) { bag.remove(topic); };
  }
  /// Its messages are on two topics.
  static auto twice(const std::string& topic, const std::string& one, const std::string& other) {
    return [=](TinyBag& bag) { bag.rename(topic, one), bag.copy(one, other); };
  }
};

TEST_F(BadBagTest, NamesWhatTheCameraLacks) {
  const std::string depth = depth_topic, info = info_topic;
  const auto edit_info = [&](const auto& change) {
    return [=](TinyBag& bag) { bag.edit<io::CameraInfoMessage>(change); };
  };
  expect_spoilt(without(depth), {"/camera/color/image_raw/compressed", "--depth-topic"});
  expect_spoilt([&](TinyBag& bag) { bag.copy(depth, "/second/depth/image_raw"); },
                {depth + ", /second/depth/image_raw", "--depth-topic"});
  expect_spoilt(without(info), {"camera_info"});
  expect_spoilt(twice(info, "/left/camera_info", "/right/camera_info"),
                {"/left/camera_info, /right/camera_info", "--camera-info-topic"});
  expect_spoilt(edit_info([](auto& message) { message.header.frame_id = "left"; }),
                {"'left'", "'optical'", "--camera-info-topic"});
  expect_spoilt(edit_info([](auto& message) { message.p[0] = 0; }), {info + ": p: "});
}

TEST_F(BadBagTest, NamesWhatTheRobotLacks) {
  expect_spoilt(without("/robot_description"), {"robot_description", "--robot"});
  expect_spoilt(
      [](TinyBag& bag) { bag.edit<io::StringMessage>([](auto& text) { text.data = "no robot"; }); },
      {"robot_description"});
  expect_spoilt([](TinyBag& bag) { bag.remove("/joint_states"), bag.remove("/tf_static"); },
                {"joint states", "tf"});
  expect_spoilt(twice("/joint_states", "/a/joint_states", "/b/joint_states"),
                {"/a/joint_states, /b/joint_states", "--joint-topic"});
  expect_spoilt(without("/tf_static"), {"has no tf", "--pose"});
  expect_spoilt(
      [](TinyBag& bag) {
        bag.edit<io::TfMessage>("/tf_static", [](auto& tf) {
          std::string& child = tf.transforms[0].child_frame_id;
          if (child == "optical") child = "lens";
        });
      },
      {"'optical'", "--camera-frame"});
}

TEST_F(BadBagTest, NamesTheOption) {
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--depth-topic", "/nowhere"}, "/nowhere"},
      {{"--depth-topic", "/joint_states"}, "sensor_msgs/msg/JointState"},
      {{"--parent", "bas"}, "bas"},
      {{"--target-topic", "/joint_states"}, "vision_msgs/msg/Detection2DArray"},
      {{"--poses", "latest"}, "--poses"},
      {{"--time-offset", "soon"}, "--time-offset"},
      {{"--frames", "1:4"}, "0 to 2"}};
  for (const auto& [options, named] : cases) expect_refused(run(options), {options[0], named});
}

TEST_F(BadBagTest, NamesTheFile) {
  expect_spoilt([](TinyBag& bag) { bag.encoding = bag.profile = "ros1"; }, {"ros1", "cdr"});
  expect_spoilt([](TinyBag& bag) { bag.messages.clear(); }, {"holds no messages"});
  const std::string whole = read_file(tiny_mcap());
  for (const auto& [file, content] : {std::pair<std::string, std::string>("empty.db3", ""),
                                      {"head.mcap", whole.substr(0, 100)},
                                      {"cut.mcap", whole.substr(0, 300)},  // in the first chunk
                                      {"text.mcap", "a text of some length, but no bag"},
                                      {"text.db3", "a text of some length, but no bag"}}) {
    write_file(path(file), content);
    expect_refused(run({}, file), {file});
  }
}

}  // namespace
}  // namespace penumbra::test
