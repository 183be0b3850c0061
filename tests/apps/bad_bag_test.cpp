// SPDX-License-Identifier: Apache-2.0
// Bags that `penumbra run` cannot take.
#include "program.hpp"
#include "tiny_bag.hpp"
#include "tiny_recording.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// A bag that is spoilt, and words that the one line on stderr must hold.
struct BadBag {
  const char* name;
  std::function<void(TinyBag&)> spoil;
  std::vector<std::string> words;
  std::vector<std::string> options = {};
};

std::ostream& operator<<(std::ostream& out, const BadBag& bad) { return out << bad.name; }

/// Spoils a bag by leaving a topic out.
std::function<void(TinyBag&)> without(const char* topic) {
  return [topic](TinyBag& bag) { bag.remove(topic); };
}

std::vector<BadBag> bad_cameras() {
  return {
      {"NoDepth",
       without("/camera/depth/image_rect_raw"),
       {"no images are called depth", "/camera/color/image_raw/compressed", "--depth-topic"}},
      {"TwoDepths",
       [](TinyBag& bag) { bag.copy("/camera/depth/image_rect_raw", "/second/depth/image_raw"); },
       {"/camera/depth/image_rect_raw, /second/depth/image_raw", "--depth-topic"}},
      {"NoCameraInfo", without("/camera/depth/camera_info"), {"has no camera_info"}},
      {"TwoCameraInfos",
       [](TinyBag& bag) {
         bag.rename("/camera/depth/camera_info", "/left/camera_info");
         bag.copy("/left/camera_info", "/right/camera_info");
       },
       {"/left/camera_info, /right/camera_info", "--camera-info-topic"}},
      {"CameraInfoOfAnotherFrame",
       [](TinyBag& bag) {
         bag.edit<io::CameraInfoMessage>("/camera/depth/camera_info",
                                         [](auto& info) { info.header.frame_id = "left"; });
       },
       {"'left'", "'optical'", "--camera-info-topic"}},
      {"CameraInfoWithoutFocalLength",
       [](TinyBag& bag) {
         bag.edit<io::CameraInfoMessage>("/camera/depth/camera_info",
                                         [](auto& info) { info.p[0] = 0; });
       },
       {"/camera/depth/camera_info: p: "}},
  };
}

std::vector<BadBag> bad_bag_robots() {
  return {
      {"NoRobot", without("/robot_description"), {"has no robot_description", "--robot"}},
      {"RobotIsNoUrdf",
       [](TinyBag& bag) {
         bag.edit<io::StringMessage>("/robot_description",
                                     [](auto& text) { text.data = "no robot"; });
       },
       {"robot_description"}},
      {"NoJointsAndNoTf",
       [](TinyBag& bag) {
         bag.remove("/joint_states");
         bag.remove("/tf_static");
       },
       {"neither joint states nor tf"}},
      {"TwoJointStates",
       [](TinyBag& bag) {
         bag.rename("/joint_states", "/a/joint_states");
         bag.copy("/a/joint_states", "/b/joint_states");
       },
       {"/a/joint_states, /b/joint_states", "--joint-topic"}},
      {"NoTf", without("/tf_static"), {"has no tf", "--pose"}},
      {"CameraNotInTf",
       [](TinyBag& bag) {
         bag.edit<io::TfMessage>("/tf_static", [](auto& tf) {
           if (tf.transforms[0].child_frame_id == "optical")
             tf.transforms[0].child_frame_id = "lens";
         });
       },
       {"'optical'", "tf does not know", "--camera-frame"}},
  };
}

std::vector<BadBag> bad_files() {
  return {
      {"OtherProfile",
       [](TinyBag& bag) {
         bag.encoding = "ros1";
         bag.profile = "ros1";
       },
       {"not a bag of ROS 2", "ros1", "cdr"}},
      {"NoMessages", [](TinyBag& bag) { bag.messages.clear(); }, {"holds no messages"}},
  };
}

std::vector<BadBag> bad_bag_options() {
  return {
      {"TopicMissing",
       [](TinyBag&) {},
       {"--depth-topic", "/nowhere"},
       {"--depth-topic", "/nowhere"}},
      {"TopicOfAnotherType",
       [](TinyBag&) {},
       {"--depth-topic", "sensor_msgs/msg/JointState"},
       {"--depth-topic", "/joint_states"}},
      {"ParentIsNoLink", [](TinyBag&) {}, {"--parent", "bas"}, {"--parent", "bas"}},
      {"TargetsOfAnotherType",
       [](TinyBag&) {},
       {"--target-topic", "vision_msgs/msg/Detection2DArray or "},
       {"--target-topic", "/joint_states"}},
      {"PosesText", [](TinyBag&) {}, {"--poses"}, {"--poses", "latest"}},
      {"TimeOffsetText", [](TinyBag&) {}, {"--time-offset"}, {"--time-offset", "soon"}},
  };
}

class BadBagTest : public testing::TestWithParam<BadBag> {};

TEST_P(BadBagTest, IsOneClearLineAndStatus2) {
  const TemporaryFolder folder;
  write_tiny_recording(folder.path());
  TinyBag bag = tiny_bag(folder.path());
  GetParam().spoil(bag);
  bag.write_mcap(folder.path() / "tiny.mcap");
  std::vector<std::string> arguments = {"run", folder.path() / "tiny.mcap", "-o",
                                        folder.path() / "out"};
  arguments.insert(arguments.end(), GetParam().options.begin(), GetParam().options.end());
  const Outcome outcome = penumbra(arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  for (const std::string& word : GetParam().words)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in: " << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(Cameras, BadBagTest, testing::ValuesIn(bad_cameras()), name_of);
INSTANTIATE_TEST_SUITE_P(Robots, BadBagTest, testing::ValuesIn(bad_bag_robots()), name_of);
INSTANTIATE_TEST_SUITE_P(Files, BadBagTest, testing::ValuesIn(bad_files()), name_of);
INSTANTIATE_TEST_SUITE_P(Options, BadBagTest, testing::ValuesIn(bad_bag_options()), name_of);

TEST(BadBagFile, IsOneClearLineAndStatus2) {
  const TemporaryFolder folder;
  write_tiny_recording(folder.path());
  tiny_bag(folder.path()).write_mcap(folder.path() / "whole.mcap");
  const std::string whole = read_file(folder.path() / "whole.mcap");
  for (const auto& [file, content] : {std::pair<std::string, std::string>("empty.mcap", ""),
                                      {"empty.db3", ""},
                                      {"head.mcap", whole.substr(0, 100)},
                                      {"text.mcap", "a text of some length, but no bag"},
                                      {"text.db3", "a text of some length, but no bag"}}) {
    write_file(folder.path() / file, content);
    const Outcome outcome = penumbra({"run", folder.path() / file, "-o", folder.path() / "out"});
    EXPECT_EQ(outcome.status, 2) << file << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << file << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  }
}

TEST(BadBagFolder, IsNeitherARecordingNorABag) {
  const TemporaryFolder folder;
  write_file(folder.path() / "notes.txt", "x");
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, {"--depth-topic", "/depth"}}) {
    std::vector<std::string> arguments = {"run", folder.path(), "-o", folder.path() / "out"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = penumbra(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find("neither a recording (recording.yaml) nor a bag"), std::string::npos)
        << outcome.err;
  }
}

}  // namespace
}  // namespace penumbra::test
