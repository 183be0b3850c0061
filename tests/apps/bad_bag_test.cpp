// SPDX-License-Identifier: Apache-2.0
// Bags that `penumbra run` cannot take.
#include "fixtures.hpp"

#include <functional>
#include <utility>

namespace penumbra::test {
namespace {

class BadBagTest : public BagTest {
 protected:
  /// The tiny bag as it is after `spoil` is refused.
  void expect_spoilt(const std::function<void(TinyBag&)>& spoil, const Words& named) {
    const TinyBag sound = bag_;
    spoil(bag_);
    expect_refused(run(), named);
    bag_ = sound;
  }
  static auto without(const char* topic) {
    return [topic](TinyBag& bag) { bag.remove(topic); };
  }
};

TEST_F(BadBagTest, NamesWhatTheCameraLacks) {
  expect_spoilt(without("/camera/depth/image_rect_raw"),
                {"/camera/color/image_raw/compressed", "--depth-topic"});
  expect_spoilt(
      [](TinyBag& bag) { bag.copy("/camera/depth/image_rect_raw", "/second/depth/image_raw"); },
      {"/camera/depth/image_rect_raw, /second/depth/image_raw", "--depth-topic"});
  expect_spoilt(without("/camera/depth/camera_info"), {"camera_info"});
  expect_spoilt(
      [](TinyBag& bag) {
        bag.rename("/camera/depth/camera_info", "/left/camera_info");
        bag.copy("/left/camera_info", "/right/camera_info");
      },
      {"/left/camera_info, /right/camera_info", "--camera-info-topic"});
  const auto edit_info = [](const auto& change) {
    return [change](TinyBag& bag) {
      bag.edit<io::CameraInfoMessage>("/camera/depth/camera_info", change);
    };
  };
  expect_spoilt(edit_info([](auto& info) { info.header.frame_id = "left"; }),
                {"'left'", "'optical'", "--camera-info-topic"});
  expect_spoilt(edit_info([](auto& info) { info.p[0] = 0; }), {"/camera/depth/camera_info: p: "});
}

TEST_F(BadBagTest, NamesWhatTheRobotLacks) {
  expect_spoilt(without("/robot_description"), {"robot_description", "--robot"});
  expect_spoilt(
      [](TinyBag& bag) {
        bag.edit<io::StringMessage>("/robot_description",
                                    [](auto& text) { text.data = "no robot"; });
      },
      {"robot_description"});
  expect_spoilt(
      [](TinyBag& bag) {
        bag.remove("/joint_states");
        bag.remove("/tf_static");
      },
      {"joint states", "tf"});
  expect_spoilt(
      [](TinyBag& bag) {
        bag.rename("/joint_states", "/a/joint_states");
        bag.copy("/a/joint_states", "/b/joint_states");
      },
      {"/a/joint_states, /b/joint_states", "--joint-topic"});
  expect_spoilt(without("/tf_static"), {"has no tf", "--pose"});
  expect_spoilt(
      [](TinyBag& bag) {
        bag.edit<io::TfMessage>("/tf_static", [](auto& tf) {
          if (tf.transforms[0].child_frame_id == "optical")
            tf.transforms[0].child_frame_id = "lens";
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
  bag_.write_mcap(path("whole.mcap"));
  const std::string whole = read_file(path("whole.mcap"));
  for (const auto& [file, content] : {std::pair<std::string, std::string>("empty.mcap", ""),
                                      {"empty.db3", ""},
                                      {"head.mcap", whole.substr(0, 100)},
                                      {"cut.mcap", whole.substr(0, 300)},  // in the first chunk
                                      {"text.mcap", "a text of some length, but no bag"},
                                      {"text.db3", "a text of some length, but no bag"}}) {
    write_file(path(file), content);
    expect_refused(run({}, file), {file});
  }
  fs::create_directory(path("folder"));
  write_file(path("folder/notes.txt"), "x");
  expect_refused(run({}, "folder"), {"recording.yaml"});
  expect_refused(run({"--depth-topic", "/depth"}, "folder"), {"recording.yaml"});
}

}  // namespace
}  // namespace penumbra::test
