// SPDX-License-Identifier: Apache-2.0
// The diagnostics of live, for example why there are no results.
#include "../support/errors.hpp"
#include "live_scene.hpp"

#include <io/live/diagnostic_changes.hpp>
#include <io/live/live_diagnostics.hpp>
#include <io/ros/name_resolver.hpp>

namespace penumbra::test {
namespace {

using Status = io::DiagnosticStatusMessage;
using Words = std::vector<std::string>;

class LiveDiagnosticsTest : public testing::Test {
 protected:
  LiveDiagnosticsTest() {
    links_.resize(bench_.inbox.topics().size());
    for (io::LiveLink& link : links_) link = {.is_open = true, .publishers = 1};
  }
  io::LiveLink& link(io::TopicRole role) {
    for (std::size_t i = 0; i < links_.size(); ++i)
      if (bench_.inbox.topics()[i].role == role) return links_[i];
    ADD_FAILURE();
    return links_[0];
  }
  Status camera() { return report().status.at(1); }
  Status robot() { return report().status.at(0); }
  io::DiagnosticArrayMessage report() {
    bench_.now += seconds / 100;
    return diagnostics_.report(bench_.inbox, links_, {bench_.now, bench_.now});
  }
  void judge() {
    bench_.tell_joints_around(bench_.now);
    bench_.tell_depth(bench_.now);
    bench_.work();
  }
  static void expect_says(const Status& status, std::uint8_t level, const std::string& what) {
    EXPECT_EQ(status.level, level) << status.message;
    EXPECT_TRUE(holds(status.message, what));
  }
  void expect_camera(std::uint8_t level, const std::string& what) {
    expect_says(camera(), level, what);
  }
  void expect_robot(std::uint8_t level, const std::string& what) {
    expect_says(robot(), level, what);
  }
  /// Publishes an image with each of these stamps, 100 ms after one another, and joint states.
  template <typename Stamp>
  void play(int images, const Stamp& stamp_at) {
    for (int i = 0; i < images; ++i) {
      bench_.now += 100 * milliseconds;
      bench_.tell_joints(bench_.now);
      bench_.tell_depth(stamp_at(bench_.now));
      bench_.work();
    }
  }
  /// Judges images with such times between them.
  void judge(int images, std::int64_t each) {
    for (int i = 0; i < images; ++i) {
      bench_.now += each;
      judge();
    }
  }

  LiveBench bench_;
  std::vector<io::LiveLink> links_;
  io::LiveDiagnostics diagnostics_{bench_.now};
};

TEST_F(LiveDiagnosticsTest, SaysWhatIsMissing) {
  link(io::TopicRole::depth).publishers = 0;
  expect_camera(Status::stale, "no publisher of /camera/depth/image_rect_raw");
  expect_robot(Status::stale, "no robot_description yet");
  link(io::TopicRole::depth) = {.is_open = true, .publishers = 0, .refused_because = "reliability"};
  expect_camera(Status::stale, "leave --reliable out");
  link(io::TopicRole::depth) = {.is_open = true, .publishers = 1};
  bench_.publish("/camera/depth/image_rect_raw", std::vector<std::byte>(3));
  expect_camera(Status::stale, "1 messages cannot be read");
  bench_.tell_depth(bench_.now);
  expect_camera(Status::error, "no camera_info yet");
  bench_.tell_info(0);
  expect_camera(Status::error, "no robot_description yet");
  bench_.tell_robot("<robot");
  expect_robot(Status::error, "robot_description");
  bench_.tell_robot();
  bench_.tell_mount();
  expect_robot(Status::stale, "no joint states yet");
  judge();
  expect_camera(Status::ok, "frames/s");
  expect_robot(Status::ok, "tiny");
}

TEST_F(LiveDiagnosticsTest, SaysWhatHasStopped) {
  bench_.tell_all();
  judge();
  bench_.now += 3 * seconds;
  expect_camera(Status::stale, "no depth images for 3.0 s");
  expect_robot(Status::stale, "no joint states for 3.0 s");
  bench_.tell_depth(bench_.now);
  bench_.now += 200 * milliseconds;
  bench_.work();
  expect_camera(Status::error, "stale_joints");
}

TEST_F(LiveDiagnosticsTest, SaysWhyJointStatesDoNotTellThePose) {
  bench_.tell_all();
  const auto tell = [&](std::int64_t stamp, std::vector<std::string> names, double position) {
    const std::vector<double> positions(names.size(), position);
    bench_.publish(
        "/joint_states",
        encoded(io::JointStateMessage{
            .header = {stamp, ""}, .names = {names.begin(), names.end()}, .positions = positions}));
  };
  tell(bench_.now, {"gripper"}, 0.1);
  expect_robot(Status::error, "none of the robot's joints: gripper");
  tell(0, {"spin"}, 0.1);
  expect_robot(Status::error, "joint states have no stamp");
  tell(bench_.now, {"spin"}, std::nan(""));
  expect_robot(Status::error, "no position that can be used");
  tell(bench_.now, {"gripper", "spin"}, 0.1);
  expect_robot(Status::ok, "its pose is known");
  for (int i = 0; i < 30; ++i) {
    bench_.now += 100 * milliseconds;
    tell(bench_.now, {"a", "b", "c", "d"}, 0.1);
  }
  expect_robot(Status::error, "no joint states of the robot for 3.0 s");
  expect_robot(Status::error, "a, b, c, ...");
}

TEST_F(LiveDiagnosticsTest, NamesImagesWhoseStampsAreZeroOrFrozen) {
  bench_.tell_all();
  play(30, [](std::int64_t) { return 0; });
  expect_camera(Status::stale, "stamps are 0");
  const std::int64_t frozen = bench_.now;
  play(30, [&](std::int64_t) { return frozen; });
  expect_camera(Status::error, "frozen");
}

TEST_F(LiveDiagnosticsTest, SaysThatAClockWasSetBack) {
  bench_.tell_all();
  judge();
  expect_robot(Status::ok, "tiny");
  for (int i = 0; i < 30; ++i) {
    play(1, [](std::int64_t now) { return now - 20 * seconds; });  // the camera's clock alone
    bench_.now += 250 * milliseconds;
    bench_.work();
  }
  expect_camera(Status::error, "20.0 s later than those of the sensor: a clock was set back");
  bench_.tell_joints(bench_.now - 60 * seconds);
  expect_robot(Status::warn, "the clock jumped back by");
  expect_robot(Status::ok, "tiny");
}

TEST_F(LiveDiagnosticsTest, AJointThatWasNeverSeenIsTheRobotsFault) {
  const std::string more =
      R"(<link name="flap"><collision><geometry><box size="0.1 0.1 0.1"/></geometry>
    </collision></link><joint name="fold" type="continuous"><parent link="board"/>
    <child link="flap"/><axis xyz="0 0 1"/></joint>
    <link name="marker"/><joint name="wave" type="continuous"><parent link="board"/>
    <child link="marker"/><axis xyz="0 0 1"/></joint></robot>)";
  std::string urdf = live_urdf;
  urdf.replace(urdf.find("</robot>"), urdf.size(), more);
  bench_.tell_robot(urdf);
  bench_.tell_joints(bench_.now);
  const Status status = robot();
  expect_says(status, Status::error, "'fold'");
  EXPECT_FALSE(holds(status.message, "wave")) << "it moves nothing that is drawn";
}

TEST_F(LiveDiagnosticsTest, OffersTheTopicWithTheSameImages) {
  const io::InputTopic& depth = bench_.inbox.topics().back();
  const auto offered = [&](const std::string& published) {
    return io::other_topic(depth, [&](const std::string& name) { return name == published; });
  };
  EXPECT_EQ(offered(depth.name + "/compressedDepth"), depth.name + "/compressedDepth");
  EXPECT_EQ(offered(depth.name + "/compressed"), depth.name + "/compressed");
  EXPECT_EQ(offered(depth.name), "") << "that is the topic itself";
  EXPECT_EQ(offered("/other"), "");
  link(io::TopicRole::depth) = {.is_open = true, .other_topic = "/camera/depth/compressedDepth"};
  expect_camera(Status::stale, "/camera/depth/compressedDepth");
}

TEST_F(LiveDiagnosticsTest, SaysWhichShareOfTheFramesIsOk) {
  bench_.tell_all();
  for (int i = 0; i < 20; ++i) {
    bench_.now += 250 * milliseconds;
    if (i % 4 == 3) {  // no joint state comes for this one
      bench_.tell_depth(bench_.now);
      bench_.now += 250 * milliseconds;
      bench_.work();
    }
    judge();
  }
  expect_camera(Status::warn, "stale_joints");
  expect_camera(Status::warn, "ok in 80 %");
  judge(50, 250 * milliseconds);
  EXPECT_FALSE(holds(camera().message, "ok in")) << "that is long ago";
}

TEST_F(LiveDiagnosticsTest, OptionsHaveTheNamesOfParameters) {
  std::string urdf = live_urdf;
  const std::string box = R"(<box size="0.4 0.2 0.1"/>)";
  urdf.replace(urdf.find(box), box.size(), R"(<mesh filename="package://none/board.stl"/>)");
  bench_.tell_robot(urdf);
  expect_robot(Status::error, " --package none=DIR");
  diagnostics_ = io::LiveDiagnostics(bench_.now, {.parameters = {"packages"}});
  expect_robot(Status::error, " packages none=DIR");
}

TEST_F(LiveDiagnosticsTest, ASlowCameraIsNotCalledSilent) {
  bench_.tell_all();
  judge(3, 2 * seconds);
  bench_.now += 1900 * milliseconds;
  expect_camera(Status::ok, "frames/s");
  bench_.now += 4 * seconds;
  expect_camera(Status::stale, "no depth images for");
}

TEST_F(LiveDiagnosticsTest, WarnsOfAWrongSetupUntilItIsAnother) {
  bench_.tell_all();
  judge();
  expect_camera(Status::ok, "frames/s");
  judge(60, 100 * milliseconds);
  EXPECT_FALSE(bench_.inbox.warnings(0).empty());  // the board is nowhere in the depth images
  expect_camera(Status::warn, bench_.inbox.warnings(0).at(0));
  for (int i = 0; i < 80; ++i) {  // without joint states nothing shows whether it is mended
    bench_.now += seconds;
    bench_.tell_depth(bench_.now - seconds / 2);
    bench_.work();
  }
  EXPECT_FALSE(bench_.inbox.warnings(0).empty());
  bench_.now += 2 * io::LiveTally::recent_time;
  bench_.tell_info(bench_.now, 70.0);
  judge();
  expect_camera(Status::ok, "frames/s");
}

io::DiagnosticArrayMessage of_cameras(const std::string& left, const std::string& right) {
  io::DiagnosticArrayMessage message;
  for (const auto& [name, why] : {std::pair("eyes: left", left), std::pair("eyes: right", right)})
    message.status.push_back({.level = why.empty() ? Status::ok : Status::error,
                              .name = name,
                              .message = why.empty() ? "3 frames/s" : why});
  return message;
}

TEST(DiagnosticChanges, ReportEachStatusByItself) {
  io::DiagnosticChanges changes;
  const Words well{"eyes: no faults: left 3 frames/s; right 3 frames/s"};
  EXPECT_EQ(changes.update(of_cameras("", "")), well);
  EXPECT_EQ(changes.update(of_cameras("no images for 1.2 s", "")),
            Words{"eyes: left: no images for 1.2 s"});
  EXPECT_EQ(changes.update(of_cameras("no images for 12.5 s", "")), Words{});
  EXPECT_EQ(changes.update(of_cameras("no images for 13.0 s", "no camera_info yet")),
            Words{"eyes: right: no camera_info yet"});
  EXPECT_EQ(changes.update(of_cameras("no images for 14.0 s", "3 images are bad")),
            Words{"eyes: right: 3 images are bad"});
  EXPECT_EQ(changes.update(of_cameras("", "4 images are bad")), Words{"eyes: left: recovered"});
  EXPECT_EQ(changes.update(of_cameras("", "")), well);
  EXPECT_EQ(changes.update(of_cameras("", "")), Words{});
}

TEST(NameResolver, ExpandsAndRemaps) {
  io::NameResolver names("cell/arm");
  EXPECT_EQ(names.resolve("joint_states"), "/cell/arm/joint_states");
  EXPECT_EQ(names.resolve("/tf"), "/tf");
  names.remap("/tf:=/cell/tf");
  names.remap("joint_states:=states");
  EXPECT_EQ(names.resolve("/tf"), "/cell/tf");
  EXPECT_EQ(names.unused(), Words{"/cell/arm/joint_states"});
  EXPECT_EQ(names.resolve("joint_states"), "/cell/arm/states");
  EXPECT_EQ(names.unused(), Words{});
  EXPECT_EQ(names.name_space(), "/cell/arm");
  for (const char* bad : {"", ":=", "a:=", ":=b", "a=b", "a:=b c", "1a:=b", "a:=b/", "a//b:=c",
                          "joint_states:=other"})
    EXPECT_THROW(names.remap(bad), InputError) << bad;
  EXPECT_THROW(io::NameResolver("no space"), InputError);
  EXPECT_THROW(static_cast<void>(names.resolve("a b")), InputError);
}

}  // namespace
}  // namespace penumbra::test
