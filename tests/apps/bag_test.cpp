// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags, against the recording folders that they are of.
#include "../io/bag_files.hpp"
#include "real_recording.hpp"

#include <limits>

#include <io/files/camera_info.hpp>

namespace penumbra::test {
namespace {

TEST_F(BagTest, GivesTheLabelsOfTheRecording) {
  EXPECT_EQ(expect_recorded().err, "");
  const Json json = report();
  ASSERT_EQ(json["frames"].size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(json["frames"][i]["index"], i);
    EXPECT_EQ(json["frames"][i]["stamp_ns"], tiny_stamp(static_cast<int>(i)));
    EXPECT_GT(json["frames"][i]["joint_age_ms"], 0.0) << "no state lies on a stamp";
  }
}

TEST_F(BagTest, ReadsSqliteBagsAndFolders) {
  bag_.write_sqlite(path("tiny.db3"));
  succeed(run({}, "tiny.db3"));
  expect_recorded_labels();

  fs::create_directory(path("recorded"));
  bag_.write_mcap(path("recorded/a_0.mcap"));
  expect_has(succeed(run({}, "recorded")).err, {"metadata.yaml: is missing"});
  expect_recorded_labels();

  write("recorded/metadata.yaml", metadata_yaml("mcap", {"a_0.mcap"}));
  EXPECT_EQ(succeed(run({}, "recorded")).err, "");
  expect_recorded_labels();
}

TEST_F(BagTest, OtherBagsAreCalledByTheirNames) {
  write("old.bag", "#ROSBAG V2.0\n");
  for (const char* command : {"run", "cloud", "calibrate"})
    expect_refused(penumbra({command, path("old.bag"), "-o", out("a.mcap")}),
                   {"ROS 1", "rosbags-convert --src " + path("old.bag").string() + " --dst"});
}

TEST_F(BagTest, ShowsColorInOverlays) {
  saves_ = "overlay";
  EXPECT_EQ(succeed(run()).err, "");
  const std::string with_color = read_file(out("overlay/000002.png"));
  bag_.edit<io::CompressedImageMessage>([](auto& image) { image.header.frame_id = "left"; });
  expect_has(succeed(run()).err, {"colour", "3 of 3"});
  EXPECT_NE(read_file(out("overlay/000002.png")), with_color);
}

TEST_F(BagTest, AddsTheTimeOffsetToStamps) {
  // What a camera says that stamps 0.4 s too early.
  bag_.edit<io::ImageMessage>([](auto& image) { image.header.stamp -= 400'000'000; });
  expect_recorded({"--time-offset", "0.4"});
  EXPECT_EQ(report()["frames"][0]["stamp_ns"], tiny_stamp(0) - 400'000'000);
  EXPECT_EQ(report()["settings"]["bag"]["time_offset_s"], 0.4);
}

TEST_F(BagTest, NamesOfJointsThatDifferAreNamed) {
  for (const auto& [name, pattern] : std::vector<std::pair<std::string, std::string>>{
           {"left/slide", "left/*=*"}, {"slide_position", "*_position=*"}, {"lid", "*=s*e"}}) {
    bag_.edit<io::JointStateMessage>([last = name](auto& state) { state.names.back() = last; });
    expect_failed(run(), {"'slide'", name, "set joint_names '" + pattern + "'"});
    EXPECT_EQ(expect_recorded({"--joint-names", pattern}).err, "");
  }
  expect_refused(run({"--joint-names", "left"}), {"joint_names 'left'"});
}

TEST_F(BagTest, TopicsThatHaveAJointAreNamed) {
  bag_.rename("/joint_states", "/arm/joint_states");
  bag_.copy("/arm/joint_states", "/joint_states");
  bag_.edit<io::JointStateMessage>("/joint_states", [](auto& state) {
    state.names.assign(1, "lift"), state.positions.resize(1);
  });
  bag_.sort();
  expect_failed(run(), {"'slide'", "'lift'", "/arm/joint_states has it", "--joint-topic"});
  EXPECT_EQ(expect_recorded({"--joint-topic", "/arm/joint_states"}).err, "");
}

TEST_F(BagTest, TheRemedyOfAMissingJointWorks) {
  TinyBag bag = recording_bag(example, Eigen::Isometry3d::Identity());
  bag.edit<io::JointStateMessage>([](auto& state) {
    state.names.pop_back();
    state.positions.pop_back();
  });
  bag.write_mcap(path("bag.mcap"));
  const auto look = [&](const Words& options) {
    const Words given = Words{"run", path("bag.mcap"), "-o", out()} + example_package + options;
    return penumbra(given).err;
  };
  const std::string links = "finger_left,finger_right";
  expect_has(look({}), {"set joint gripper_left=VALUE, or ignore_links " + links});
  for (const Words& remedy :
       {Words{"--ignore-links", links}, Words{"--joint", "gripper_left=0.02"}})
    expect_lacks(look(remedy), {"missing_link", "never seen"});
}

TEST_F(BagTest, ClocksThatDifferAreNamed) {
  const auto shift = [&](std::int64_t by) {
    bag_.edit<io::JointStateMessage>([&](auto& state) { state.header.stamp += by; });
  };
  shift(2'000'000'000);
  expect_failed(run(), {"ms newer", "sensor's", "change time_offset by about 2.0"});
  EXPECT_EQ(succeed(run({"--time-offset", "2"})).err, "");
  shift(-4'000'000'000);
  expect_failed(run(), {"ms older", "before", "change time_offset by about -2.0"});
  shift(1'700'000'000'000'000'000);
  expect_failed(run(), {"use_sim_time"});
}

std::vector<std::uint16_t> millimetres_of(const io::ImageMessage& image) {
  std::vector<std::uint16_t> millimetres(image.data.size() / 2);
  std::memcpy(millimetres.data(), image.data.data(), image.data.size());
  return millimetres;
}

TEST_F(BagTest, TheScaleOfDepthIsAnOption) {
  std::vector<std::uint16_t> scaled;
  bag_.edit<io::ImageMessage>([&](auto& image) {
    scaled = millimetres_of(image);
    for (std::uint16_t& depth : scaled) depth = static_cast<std::uint16_t>(10 * depth);
    image.data = std::as_bytes(std::span(scaled));
  });
  EXPECT_EQ(expect_recorded({"--depth-scale", "0.0001"}).err, "");
}

TEST_F(BagTest, DepthAlongTheRayIsAnOption) {
  const Camera camera = io::read_camera_info(path("camera_info.yaml"), false);
  std::vector<float> metres;
  bag_.edit<io::ImageMessage>([&](auto& image) {
    const std::vector<std::uint16_t> depth = millimetres_of(image);
    metres.clear();
    for (unsigned i = 0; i < depth.size(); ++i)
      metres.push_back(static_cast<float>(
          1e-3 * depth[i] * camera.intrinsics.ray(i % image.width, i / image.width).norm()));
    image.encoding = "32FC1";
    image.step = 4 * image.width;
    image.data = std::as_bytes(std::span(metres));
  });
  EXPECT_EQ(expect_recorded({"--depth-along", "ray"}).err, "");
}

TEST_F(BagTest, FaultyImagesAreFramesOfAStatus) {
  int image = 0;
  bag_.edit<io::ImageMessage>([&](auto& depth) {
    if (image == 0) depth.encoding = "13UC7";
    if (image == 1) depth.header.stamp = 0;
    if (image == 2) depth.header.frame_id = "elsewhere";
    ++image;
  });
  std::ranges::find(bag_.messages, "/joint_states", &TinyBag::Message::topic)->data.resize(20);
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2) << "no frame is usable";
  EXPECT_EQ(statuses(), (Words{"bad_depth", "missing_joints", "bad_depth"}));
  expect_has(message(0), {"13UC7"});
  expect_has(message(1), {"stamp is 0"});
  expect_has(message(2), {"'elsewhere'"});
  for (const std::string& said : {notes(), outcome.err})
    expect_has(said, {"1 message of /joint_states"});
}

TEST_F(BagTest, JointPositionsThatAreNoNumbersAreTold) {
  int state = 0;
  bag_.edit<io::JointStateMessage>([&](auto& joints) {
    if (++state == 3) joints.positions.at(1) = std::numeric_limits<double>::quiet_NaN();
    if (state == 4) joints.positions.resize(1);
  });
  expect_has(succeed(run()).err, {"tiny.mcap: ", ": 2 "});
  expect_has(notes(), {"joint positions not used: 2 "});
}

TEST_F(BagTest, DamageIsToldAndTheRestIsJudged) {
  const std::string whole = read_file(tiny_mcap());
  write("cut.mcap", whole.substr(0, whole.size() * 7 / 10));
  const Outcome outcome = succeed(run({}, "cut.mcap"));
  const std::size_t frames = report()["frames"].size();
  EXPECT_GE(frames, 1U);
  EXPECT_LT(frames, 3U);
  for (const std::string& said : {notes(), outcome.err}) expect_has(said, {"cut.mcap: byte "});
  expect_recorded_labels(0, 1);
}

TEST_F(BagTest, TheCommandLineFillsInWhatIsMissing) {
  bag_.remove("/robot_description");
  bag_.remove("/tf_static");
  expect_recorded(
      {"--robot", path("tiny.urdf"), "--pose", path("camera_pose.csv"), "--parent", "base"});
}

TEST_F(BagTest, OptionsChooseAmongTopics) {
  bag_.copy(depth_topic, "/other/depth/image");
  bag_.copy(info_topic, "/other/camera_info");
  bag_.copy("/joint_states", "/second/joint_states");
  bag_.rename("/joint_states", "/first/joint_states");
  expect_recorded({"--depth-topic", "/other/depth/image", "--camera-info-topic",
                   "/other/camera_info", "--joint-topic", "/first/joint_states", "--joint-topic",
                   "/second/joint_states"});
}

TEST_F(BagTest, TakesPosesFromTransforms) {
  bag_.add_board_frames();
  for (const char* const poses : {"tf", "both", "joints"}) expect_recorded({"--poses", poses});
  bag_.edit<io::TfMessage>(
      "/tf", [](auto& tf) { tf.transforms[0].T_parent_child.translation().z() += 0.01; });
  const Outcome outcome = run({"--poses", "both"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(statuses()[1], "poses_disagree");
  expect_has(outcome.err, {"poses_disagree", "3 of 3"});

  bag_.remove("/joint_states");
  expect_has(run().out, {"poses: from tf"});
}

TEST_F(BagTest, ACameraMayStandBesideTheRobotInACell) {
  bag_.edit<io::TfMessage>("/tf_static", [](auto& tf) {
    if (tf.transforms[0].header.frame_id == "base") tf.transforms[0].header.frame_id = "cell";
  });
  bag_.add("/tf_static", tiny_stamp(0) - 190'000'000,
           io::TfMessage{{{{0, "cell"}, "base", Eigen::Isometry3d::Identity()}}});
  bag_.sort();
  expect_has(expect_recorded().out, {"'base'"});
}

TEST_F(BagTest, JointStatesOfTwoPublishersThatDisagreeAreReportedAndNotUsed) {
  // joint_state_publisher beside the driver: all joints of its own order, no sliders moved.
  const TinyBag alone = bag_;
  for (std::int64_t stamp = tiny_stamp(0) - 190'000'000; stamp < tiny_stamp(3);
       stamp += 100'000'000)
    bag_.add("/joint_states", stamp,
             io::JointStateMessage{
                 .header = {stamp, ""}, .names = {"slide", "other"}, .positions = {-0.3, 0.0}});
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(statuses()[1], "poses_disagree");
  expect_has(outcome.err,
             {"poses_disagree", "3 of 3", "joint 'slide' is at ",
              "/joint_states (2 joints from 'other')", "/joint_states (2 joints from 'slide')"});

  bag_ = alone;
  bag_.copy("/joint_states", "/second/joint_states");
  bag_.edit<io::JointStateMessage>("/second/joint_states", [](auto& state) {
    state.header.stamp += 1'000'000;
    state.positions[1] = -0.3;
  });
  const Words both = {"--joint-topic", "/joint_states", "--joint-topic", "/second/joint_states"};
  EXPECT_EQ(run(both).status, 2);
  expect_recorded(both + Words{"--first-publisher"});
}

/// Share of the robot's pixels whose labels may differ: the contract of `run`. Positions are
/// interpolated between states of a smooth path.
constexpr double differing_share = 1e-3;

/// A bag that the reference library wrote: the arm moves through every frame, and images are
/// recorded 30 ms after their stamps.
TEST_F(BagTest, OfARealRobotGivesTheLabelsOfItsRecording) {
  PENUMBRA_REQUIRE_DATA();
  const fs::path recording = data_folder() / "xarm7_realsense";
  const auto run_into = [](const fs::path& to, const Words& options) {
    EXPECT_EQ(succeed(penumbra(Words{"run", "-o", to, "--save", "labels"} + options)).err, "");
  };
  run_into(path("wanted"), {recording});
  run_into(out(), Words{recording / "xarm7.mcap"} + xarm_package());
  for (std::size_t i = 0; i < 10; ++i) {
    const auto of_bag = labels(i);
    const auto wanted = read_image<std::uint8_t>(path("wanted/labels") / numbered(i));
    ASSERT_EQ(of_bag.size(), wanted.size());
    std::size_t robot = 0, differ = 0;
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      if (wanted.data()[p] != 0) ++robot;
      if (of_bag.data()[p] != wanted.data()[p]) ++differ;
    }
    EXPECT_LT(static_cast<double>(differ), differing_share * static_cast<double>(robot)) << i;
  }
}

}  // namespace
}  // namespace penumbra::test
