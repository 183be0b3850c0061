// SPDX-License-Identifier: Apache-2.0
// Bags whose frames have other names than the robot's links: with a slash, with a prefix.
#include "detections.hpp"
#include "fixtures.hpp"

#include <map>

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

  /// TF of the board, as robot_state_publisher sends it.
  void add_board() {
    for (std::int64_t stamp = tiny_stamp(0) - 130'000'000; stamp < tiny_stamp(3);
         stamp += 100'000'000) {
      const double seconds = static_cast<double>(stamp - tiny_stamp(0)) * 1e-9;
      const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 1 + tiny_speed * seconds));
      bag_.add("/tf", stamp, io::TfMessage{{{{stamp, "base"}, "board", pose}}});
    }
  }
};

// A bag recorded next to a node has its results, too.
TEST_F(BagNamesTest, ResultsOfPenumbraAreNoInput) {
  for (const char* const result : {"filtered_depth", "virtual_depth"})
    bag_.copy("/camera/depth/image_rect_raw", std::string("/cell/penumbra/") + result);
  bag_.copy("/camera/depth/camera_info", "/cell/penumbra/camera_info");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expect_recorded_labels();
}

TEST_F(BagNamesTest, ALeadingSlashIsNothing) {
  add_board();
  rename_frames([](const std::string& frame) { return "/" + frame; });
  for (const char* const poses : {"joints", "tf", "both"}) {
    ASSERT_EQ(run({"--poses", poses}).status, 0) << poses;
    expect_recorded_labels();
  }
  bag_.edit<io::ImageMessage>("/camera/depth/image_rect_raw",
                              [](auto& image) { image.header.frame_id = "/optical"; });
  ASSERT_EQ(run().status, 0) << "of images, too";
  expect_recorded_labels();
  ASSERT_EQ(run({"--camera-frame", "/optical"}).status, 0);
  expect_recorded_labels();
}

TEST_F(BagNamesTest, FramesOfARobotMayHaveAPrefix) {
  add_board();
  rename_frames([](const std::string& frame) {
    return frame == "base" || frame == "board" ? "left/" + frame : frame;
  });
  const Outcome without = run({"--poses", "tf"});
  EXPECT_EQ(without.status, 2);
  expect_has(without.err, {"'optical'"});
  for (const char* const prefix : {"left/", "/left/"})
    for (const char* const poses : {"joints", "tf", "both"}) {
      const Outcome outcome = run({"--poses", poses, "--frame-prefix", prefix});
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      expect_has(outcome.out, {"'optical'", "'base'"});
      expect_recorded_labels();
    }
  const Outcome other = run({"--poses", "tf", "--frame-prefix", "right/"});
  EXPECT_EQ(other.status, 2);
}

/// Of a Detection3DArray: 8 cm wide.
Detection cube(const std::string& id, double x, double y, double z) {
  return {id, {x, y, z, 0.0, 0.0, 0.0, 1.0, 0.08, 0.08, 0.08}};
}

TEST_F(BagNamesTest, BoxesOfADetectorAreJudgedInFramesOfLinksAndTheCamera) {
  const std::int64_t stamp = tiny_stamp(1), arrival = stamp + 300'000'000;
  const auto add = [&](const std::string& frame, const std::string& topic) {
    bag_.messages.push_back(
        {topic, "vision_msgs/msg/Detection3DArray", arrival,
         detections_payload({stamp, frame}, {cube("box 0", 0.15, 0.05, 2.0),     // behind the board
                                             cube("box 1", 0.6, 0.4, 3.03)})});  // before the wall
  };
  add("optical", "/of_camera");
  add("left/base", "/of_link");
  add("/left/base", "/of_slash");
  add("base", "/of_other");
  rename_frames([](const std::string& frame) { return frame == "base" ? "left/" + frame : frame; });
  std::vector<std::string> options = {"--frame-prefix", "left/"};
  for (const char* const topic : {"/of_camera", "/of_link", "/of_slash", "/of_other"})
    options.insert(options.end(), {"--target-topic", topic});
  const Outcome outcome = run(options);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::map<std::string, std::string> verdicts;
  const Json json = report();
  for (const Json& target : json["frames"][2]["targets"]) {
    verdicts[target["name"]] = target["verdict"];
    if (std::string(target["name"]).starts_with("/of_other")) {
      expect_has(std::string(target["reason"]), {"'base'"});
    }
  }
  for (const std::string topic : {"/of_camera", "/of_link", "/of_slash"}) {
    EXPECT_EQ(verdicts[topic + "/box 0"], "hidden") << topic;
    EXPECT_EQ(verdicts[topic + "/box 1"], "visible") << topic;
  }
  EXPECT_EQ(verdicts["/of_other/box 0"], "unknown");
}

}  // namespace
}  // namespace penumbra::test
