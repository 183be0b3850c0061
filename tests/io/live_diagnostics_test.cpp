// SPDX-License-Identifier: Apache-2.0
// What is said of how it goes, and why nothing comes.
#include "live_scene.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>

#include <io/live/diagnostic_changes.hpp>
#include <io/live/live_diagnostics.hpp>
#include <io/live/live_summary.hpp>
#include <io/live/name_resolver.hpp>

namespace penumbra::test {
namespace {

using Status = io::DiagnosticStatusMessage;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

class LiveDiagnosticsTest : public testing::Test {
 protected:
  LiveDiagnosticsTest() {
    links_.resize(bench_.inbox.topics().size());
    for (io::LiveLink& link : links_) link = {.is_open = true, .publishers = 1};
  }
  io::LiveLink& link(io::LiveRole role) {
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
    bench_.tell_joints(bench_.now - 10 * milliseconds);
    bench_.tell_joints(bench_.now + 10 * milliseconds);
    bench_.tell_depth(bench_.now);
    bench_.work();
  }
  static Words values_of(const Status& status, const std::string& key) {
    Words values;
    for (const auto& value : status.values)
      if (value.key == key) values.push_back(value.value);
    return values;
  }
  static void expect_says(const Status& status, std::uint8_t level, const std::string& what) {
    EXPECT_EQ(status.level, level) << status.message;
    EXPECT_NE(status.message.find(what), std::string::npos) << status.message;
  }

  LiveBench bench_;
  std::vector<io::LiveLink> links_;
  io::LiveDiagnostics diagnostics_{bench_.now};
};

TEST_F(LiveDiagnosticsTest, SaysWhatIsMissing) {
  link(io::LiveRole::depth).publishers = 0;
  expect_says(camera(), Status::stale, "no publisher of /camera/depth/image_rect_raw");
  expect_says(robot(), Status::stale, "no robot_description yet");
  link(io::LiveRole::depth) = {.is_open = true, .publishers = 0, .refused_because = "reliability"};
  expect_says(camera(), Status::stale, "leave --reliable out");
  link(io::LiveRole::depth) = {.is_open = true, .publishers = 1};
  bench_.tell_depth(bench_.now);
  expect_says(camera(), Status::error, "no camera_info yet");
  bench_.tell_info(0);
  expect_says(camera(), Status::error, "no robot_description yet");
  bench_.tell_robot("<robot");
  expect_says(robot(), Status::error, "robot_description");
  bench_.tell_robot();
  bench_.tell_mount();
  expect_says(robot(), Status::stale, "no joint states yet");
  judge();
  expect_says(camera(), Status::ok, "frames/s");
  expect_says(robot(), Status::ok, "tiny");
}

TEST_F(LiveDiagnosticsTest, SaysWhatHasStopped) {
  bench_.tell_all();
  judge();
  bench_.now += 3 * seconds;
  expect_says(camera(), Status::stale, "no depth images for 3.0 s");
  expect_says(robot(), Status::stale, "no joint states for 3.0 s");
  bench_.tell_depth(bench_.now);
  bench_.now += 200 * milliseconds;
  bench_.work();
  expect_says(camera(), Status::error, "stale_joints");
}

TEST_F(LiveDiagnosticsTest, TellsUnreadableMessages) {
  bench_.tell_all();
  bench_.tell("/camera/depth/image_rect_raw", std::vector<std::byte>(3));
  expect_says(camera(), Status::stale, "1 messages cannot be read");
}

TEST_F(LiveDiagnosticsTest, TellsWhatWasNotUsed) {
  const auto value_of = [](const Status& status, const std::string& key) -> std::string {
    for (const auto& value : status.values)
      if (value.key == key && value.value.find("transforms") == std::string::npos)
        return value.value;
    return {};
  };
  io::LiveOptions options = LiveBench::one_camera();
  options.target_topics = {"/wrist"};
  LiveBench bench(options);
  for (std::size_t i = 0; i < bench.inbox.topics().size(); ++i)
    if (bench.inbox.topics()[i].role == io::LiveRole::targets)
      bench.inbox.set_type(i, "geometry_msgs/msg/PoseStamped");
  const auto report_of = [&] {
    bench.now += seconds / 100;
    const std::vector<io::LiveLink> links(bench.inbox.topics().size());
    return io::LiveDiagnostics(bench.now).report(bench.inbox, links, {bench.now, bench.now});
  };
  const char* const early = "target messages before robot and camera were known";
  EXPECT_EQ(value_of(report_of().status.at(1), early), "");
  bench.tell("/wrist", encoded(io::PoseStampedMessage{.header = {bench.now, "optical"}}));
  bench.tell_all();
  EXPECT_EQ(value_of(report_of().status.at(1), early), "1");

  EXPECT_EQ(value_of(report_of().status.at(0), "note"), "");
  bench.tell("/joint_states",
             encoded(io::JointStateMessage{
                 .header = {bench.now, ""}, .names = {"spin"}, .positions = {std::nan("")}}));
  EXPECT_NE(value_of(report_of().status.at(0), "note").find("joint positions not used: 1 "),
            std::string::npos);
}

TEST_F(LiveDiagnosticsTest, TellsWhatDraws) {
  bench_.tell_all();
  EXPECT_EQ(values_of(camera(), "renderer backend"), Words{}) << "nothing draws yet";
  judge();
  const Status drawn = camera();
  EXPECT_EQ(values_of(drawn, "renderer backend"), Words{"cpu"});
  EXPECT_EQ(values_of(drawn, "renderer isa"), Words{simd_target_names().front()});
  EXPECT_EQ(values_of(drawn, "renderer threads"), Words{"1"});
  const std::string summary = io::live_summary_json(bench_.inbox, links_, {.results = {{}}});
  EXPECT_NE(summary.find("\"backend\": \"cpu\""), std::string::npos) << summary;
  EXPECT_NE(summary.find("\"fault\": null"), std::string::npos) << summary;
}

TEST_F(LiveDiagnosticsTest, TheSummaryCountsWhatWasPublished) {
  io::WrittenResults results{.not_written = 4};
  results.written[static_cast<std::size_t>(io::Result::labels)] = 17;
  const Json summary =
      Json::parse(io::live_summary_json(bench_.inbox, links_, {.results = {results}}));
  EXPECT_EQ(summary["results_not_written"], 4);
  const Json& written = summary["cameras"][0]["results_written"];
  EXPECT_EQ(written["labels"], 17);
  EXPECT_EQ(written["overlay/compressed"], 0);
}

TEST_F(LiveDiagnosticsTest, SaysWhyJointStatesDoNotTellThePose) {
  bench_.tell_all();
  const auto tell = [&](std::int64_t stamp, std::vector<std::string> names, double position) {
    const std::vector<double> positions(names.size(), position);
    bench_.tell(
        "/joint_states",
        encoded(io::JointStateMessage{
            .header = {stamp, ""}, .names = {names.begin(), names.end()}, .positions = positions}));
  };
  tell(bench_.now, {"gripper"}, 0.1);
  expect_says(robot(), Status::error, "none of the robot's joints: gripper");
  tell(0, {"spin"}, 0.1);
  expect_says(robot(), Status::error, "joint states have no stamp");
  tell(bench_.now, {"spin"}, std::nan(""));
  expect_says(robot(), Status::error, "no position that can be used");
  tell(bench_.now, {"gripper", "spin"}, 0.1);
  expect_says(robot(), Status::ok, "its pose is known");
  for (int i = 0; i < 30; ++i) {
    bench_.now += 100 * milliseconds;
    tell(bench_.now, {"a", "b", "c", "d"}, 0.1);
  }
  expect_says(robot(), Status::error, "no joint states of the robot for 3.0 s");
  expect_says(robot(), Status::error, "a, b, c, ...");
}

TEST_F(LiveDiagnosticsTest, SaysThatCameraInfosNoLongerComeWithImages) {
  bench_.tell_all();
  for (int i = 0; i < 20; ++i) {
    bench_.now += 33 * milliseconds;
    if (i < 10) bench_.tell_info(bench_.now);
    judge();
  }
  bench_.now += 100 * milliseconds;
  bench_.work();
  expect_says(camera(), Status::error, "10 images have no camera_info of their own");
  EXPECT_EQ(values_of(camera(), "dropped: no_camera_info"), Words{"10"});
}

TEST_F(LiveDiagnosticsTest, SaysWhoItIs) {
  const auto told = io::LiveDiagnostics(bench_.now, {"penumbra /cell", "left-arm-pc"})
                        .report(bench_.inbox, links_, {bench_.now + seconds, bench_.now});
  EXPECT_EQ(told.status.at(0).name, "penumbra /cell: robot");
  EXPECT_EQ(told.status.at(1).name, "penumbra /cell: camera");
  for (const Status& status : told.status) EXPECT_EQ(status.hardware_id, "left-arm-pc");
}

TEST_F(LiveDiagnosticsTest, ASlowCameraIsNotCalledSilent) {
  bench_.tell_all();
  for (int i = 0; i < 3; ++i) {
    bench_.now += 2 * seconds;
    judge();
  }
  bench_.now += 1900 * milliseconds;
  expect_says(camera(), Status::ok, "frames/s");
  bench_.now += 4 * seconds;
  expect_says(camera(), Status::stale, "no depth images for");
}

io::DiagnosticArrayMessage of_cameras(const std::string& left, const std::string& right) {
  io::DiagnosticArrayMessage message;
  for (const auto& [name, why] : {std::pair("left", left), std::pair("right", right)})
    message.status.push_back({.level = why.empty() ? Status::ok : Status::error,
                              .name = name,
                              .message = why.empty() ? "3 frames/s" : why});
  return message;
}

TEST(DiagnosticChanges, ReportEachStatusByItself) {
  io::DiagnosticChanges changes;
  EXPECT_EQ(changes.update(of_cameras("", "")), Words{});
  EXPECT_EQ(changes.update(of_cameras("no images for 1.2 s", "")),
            Words{"left: no images for 1.2 s"});
  EXPECT_EQ(changes.update(of_cameras("no images for 12.5 s", "")), Words{});
  EXPECT_EQ(changes.update(of_cameras("no images for 13.0 s", "no camera_info yet")),
            Words{"right: no camera_info yet"});
  EXPECT_EQ(changes.update(of_cameras("no images for 14.0 s", "3 images are bad")),
            Words{"right: 3 images are bad"});
  EXPECT_EQ(changes.update(of_cameras("", "4 images are bad")), Words{"left: recovered"});
  EXPECT_EQ(changes.update(of_cameras("", "")), Words{"penumbra: no faults"});
  EXPECT_EQ(changes.update(of_cameras("", "")), Words{});
}

TEST(DiagnosticChanges, DoNotIncludeNumbersOfAnySignAndSize) {
  io::DiagnosticChanges changes;
  EXPECT_EQ(changes.update(of_cameras("frame 'a-b' is 0.25 m off, at 7 ns", "")).size(), 1U);
  for (const char* const same :
       {"frame 'a-b' is -0.25 m off, at 7 ns", "frame 'a-b' is 2.5e-05 m off, at -12 ns",
        "frame 'a-b' is -1e+06 m off, at 0 ns"})
    EXPECT_EQ(changes.update(of_cameras(same, "")), Words{}) << same;
  EXPECT_EQ(changes.update(of_cameras("frame 'ab' is 0.25 m off, at 7 ns", "")).size(), 1U);
}

/// Of an arm that moves: other joints, values and publishers each second.
TEST(DiagnosticChanges, TreatAllContradictingJointsAsOneFault) {
  io::DiagnosticChanges changes;
  const auto told = [&](const std::string& why) {
    return changes.update(of_cameras("poses_disagree: joint " + why, "")).size();
  };
  EXPECT_EQ(told("'a' is at 0.1 by one and at 0.5 by other (7 ns)"), 1U);
  EXPECT_EQ(told("'a' is at -0.1 by one and at 1e-05 by other (9 ns); so is 'b', 'c'"), 0U);
  EXPECT_EQ(told("'b' is at 0.2 by other and at 0.1 by one (11 ns); so is 'c'"), 0U);
  EXPECT_EQ(changes.update(of_cameras("stale_joints: joint 'a' has no position", "")).size(), 1U);
}

TEST_F(LiveDiagnosticsTest, IsAMessage) {
  bench_.tell_all();
  judge();
  std::vector<std::byte> payload;
  io::encode(report(), payload);
  io::DiagnosticArrayMessage message;
  EXPECT_FALSE(io::Decoder<io::DiagnosticArrayMessage>().decode(payload, message));
  EXPECT_EQ(message.status.size(), 2U);
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
