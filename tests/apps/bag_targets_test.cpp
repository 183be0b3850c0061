// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags: frames with other names than the robot's links, and targets.
#include "fixtures.hpp"

#include <map>

#include <Eigen/Geometry>

#include <io/ros/cdr_writer.hpp>

namespace penumbra::test {
namespace {

class BagNamesTest : public BagTest {
 protected:
  template <typename Rename>
  void rename_frames(const Rename& rename) {
    for (const char* const topic : {"/tf", "/tf_static"})
      bag_.edit<io::TfMessage>(topic, [&](auto& tf) {
        for (io::TransformMessage& t : tf.transforms) {
          t.header.frame_id = rename(t.header.frame_id);
          t.child_frame_id = rename(t.child_frame_id);
        }
      });
  }
};

// A bag recorded next to a node has its results, too.
TEST_F(BagNamesTest, ResultsOfPenumbraAreNoInput) {
  for (const char* const result : {"filtered_depth", "virtual_depth"})
    bag_.copy("/camera/depth/image_rect_raw", std::string("/cell/penumbra/") + result);
  bag_.copy("/camera/depth/camera_info", "/cell/penumbra/camera_info");
  succeed(run());
  expect_recorded_labels();
}

TEST_F(BagNamesTest, ALeadingSlashIsNothing) {
  bag_.add_board_frames();
  rename_frames([](const std::string& frame) { return "/" + frame; });
  for (const char* const poses : {"joints", "tf", "both"}) {
    succeed(run({"--poses", poses}));
    expect_recorded_labels();
  }
  bag_.edit<io::ImageMessage>("/camera/depth/image_rect_raw",
                              [](auto& image) { image.header.frame_id = "/optical"; });
  for (const Words& options : {Words{}, {"--camera-frame", "/optical"}}) {
    succeed(run(options));
    expect_recorded_labels();
  }
}

TEST_F(BagNamesTest, FramesOfARobotMayHaveAPrefix) {
  bag_.add_board_frames();
  rename_frames([](const std::string& frame) {
    return frame == "base" || frame == "board" ? "left/" + frame : frame;
  });
  expect_refused(run({"--poses", "tf"}), {"--frame-prefix left/"});
  for (const char* const prefix : {"left/", "/left/"})
    for (const char* const poses : {"joints", "tf", "both"}) {
      expect_has(succeed(run({"--poses", poses, "--frame-prefix", prefix})).out,
                 {"'optical'", "'base'"});
      expect_recorded_labels();
    }
  EXPECT_EQ(run({"--poses", "tf", "--frame-prefix", "right/"}).status, 2);
}

/// Targets of messages that come 0.3 s after frame 1, when the next frame is there.
class BagTargets : public BagNamesTest {
 protected:
  static constexpr std::int64_t stamp = tiny_stamp(1), arrival = stamp + 300'000'000;

  /// A detection of vision_msgs: all fields of its BoundingBox2D or BoundingBox3D.
  struct Detection {
    std::string id;
    std::vector<double> box;
  };
  /// Of a Detection2DArray, pixels.
  static Detection square(const std::string& id, double u, double v, double size) {
    return {id, {u, v, 0.0, size, size}};
  }
  /// Of a Detection3DArray: 8 cm wide.
  static Detection cube(const std::string& id, double x, double y, double z) {
    return {id, {x, y, z, 0.0, 0.0, 0.0, 1.0, 0.08, 0.08, 0.08}};
  }
  /// Adds a Detection2DArray or Detection3DArray, by the fields of their definitions.
  void add(const std::string& topic, const std::string& type, const std::string& frame,
           const std::vector<Detection>& detections) {
    TinyBag::Message& message = bag_.messages.emplace_back(topic, type, arrival);
    io::CdrWriter writer(message.data);
    const auto write_header = [&] {
      writer.write(static_cast<std::int32_t>(stamp / 1'000'000'000));
      writer.write(static_cast<std::uint32_t>(stamp % 1'000'000'000));
      writer.write_string(frame);
    };
    write_header();
    writer.write_count(detections.size());
    for (const Detection& detection : detections) {
      write_header();
      writer.write_count(0);  // hypotheses
      for (const double value : detection.box) writer.write(value);
      writer.write_string(detection.id);
    }
  }
  void add_pose(const std::string& topic, const std::string& frame) {
    bag_.add(
        topic, arrival,
        io::PoseStampedMessage{{stamp, frame}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2))});
  }

  /// Runs and returns the verdicts of frame 1 by the targets' names. `reason`: why the target
  /// `unknown` is so.
  std::map<std::string, std::string> verdicts(const Words& topics, const std::string& unknown,
                                              const Words& reason, Words options = {}) {
    for (const std::string& topic : topics)
      options.insert(options.end(), {"--target-topic", topic});
    out_ = succeed(run(options)).out;
    std::map<std::string, std::string> all;
    const Json json = report();
    EXPECT_TRUE(json["frames"][0]["targets"].empty() && json["frames"][2]["targets"].empty());
    for (const Json& target : json["frames"][1]["targets"]) {
      all[target["name"]] = target["verdict"];
      if (target["name"] == unknown) expect_has(std::string(target["reason"]), reason);
    }
    return all;
  }

  std::string out_;
};

TEST_F(BagTargets, OfADetectorIn3DAreJudgedInFramesOfLinksAndTheCamera) {
  for (const auto& [frame, topic] : {std::pair("optical", "/of_camera"),
                                     {"left/base", "/of_link"},
                                     {"/left/base", "/of_slash"},
                                     {"base", "/of_other"}})
    add(topic, "vision_msgs/msg/Detection3DArray", frame,
        {cube("box 0", 0.15, 0.05, 2.0),   // behind the board
         cube("box 1", 0.6, 0.4, 3.03)});  // before the wall
  rename_frames([](const std::string& frame) { return frame == "base" ? "left/" + frame : frame; });
  auto all = verdicts({"/of_camera", "/of_link", "/of_slash", "/of_other"}, "/of_other/box 0",
                      {"'base'"}, {"--frame-prefix", "left/"});
  for (const std::string topic : {"/of_camera", "/of_link", "/of_slash"}) {
    EXPECT_EQ(all[topic + "/box 0"], "hidden") << topic;
    EXPECT_EQ(all[topic + "/box 1"], "visible") << topic;
  }
  EXPECT_EQ(all["/of_other/box 0"], "unknown");
}

TEST_F(BagTargets, AreJudgedOnTheFrameOfTheirStamp) {
  // On the object before the board, on the board, on the wall.
  add("/detections", "vision_msgs/msg/Detection2DArray", "optical",
      {square("object", 28, 24, 6), square("board", 22, 26, 3), square("wall", 5, 5, 4)});
  bag_.add("/wrist", arrival,
           io::KeypointsMessage{{stamp, "optical"}, {{"left", 28, 24, 0.9, 0.5}}});
  add_pose("/far", "map");
  add_pose("/goal", "base");
  EXPECT_EQ(verdicts({"/detections", "/wrist", "/goal", "/far"}, "/far", {"'map' is neither"}),
            (std::map<std::string, std::string>{{"/detections/object", "unknown"},
                                                {"/detections/board", "hidden"},
                                                {"/detections/wall", "visible"},
                                                {"/wrist/left", "visible"},
                                                {"/goal", "hidden"},
                                                {"/far", "unknown"}}))
      << "an object that a detector first sees beside the robot may be larger than what it sees";
  expect_has(out_, {"/wrist", "penumbra_msgs/msg/Keypoints"});
}

/// A turntable of which nothing is drawn, and which two programs see turned differently.
TEST_F(BagTargets, InALinkThatTwoProgramsPutElsewhereAreUnknown) {
  bag_.edit<io::StringMessage>("/robot_description", [](auto& urdf) {
    urdf.data.insert(urdf.data.rfind("</robot>"), R"(<link name="turntable"/>
      <joint name="turn" type="continuous"><parent link="base"/><child link="turntable"/></joint>)");
  });
  bag_.edit<io::JointStateMessage>("/joint_states", [](auto& state) {
    state.names[0] = "turn";
    state.positions[0] = 0.0;
  });
  add_pose("/goal", "turntable");
  EXPECT_EQ(verdicts({"/goal"}, "", {})["/goal"], "hidden");
  expect_recorded_labels();
  for (std::int64_t at = tiny_stamp(0) - 190'000'000; at < tiny_stamp(3); at += 50'000'000)
    bag_.add("/joint_states", at,
             io::JointStateMessage{.header = {at, ""}, .names = {"turn"}, .positions = {0.7}});
  EXPECT_EQ(verdicts({"/goal"}, "/goal", {"'turntable'", "joint 'turn' is at "})["/goal"],
            "unknown");
  expect_recorded_labels();
}

}  // namespace
}  // namespace penumbra::test
