// SPDX-License-Identifier: Apache-2.0
// What is said of how it goes, and why nothing comes.
#include "live_scene.hpp"

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>

#include <io/live/live_diagnostics.hpp>
#include <io/live/name_resolver.hpp>

namespace penumbra::test {
namespace {

using Status = io::DiagnosticStatusMessage;

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
  EXPECT_EQ(names.resolve("joint_states"), "/cell/arm/states");
  for (const char* bad : {"", ":=", "a:=", ":=b", "a=b", "a:=b c", "1a:=b", "a:=b/", "a//b:=c",
                          "joint_states:=other"})
    EXPECT_THROW(names.remap(bad), InputError) << bad;
  EXPECT_THROW(io::NameResolver("no space"), InputError);
  EXPECT_THROW(static_cast<void>(names.resolve("a b")), InputError);
}

}  // namespace
}  // namespace penumbra::test
