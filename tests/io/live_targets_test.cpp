// SPDX-License-Identifier: Apache-2.0
// Targets that come on live topics: which image they are judged on, and what becomes of the others.
#include "live_scene.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// A board before the camera, and a turntable of which nothing is drawn.
constexpr const char* turntable_urdf = R"(<robot name="cell">
  <link name="base"/><link name="turntable"/>
  <link name="board">
    <collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision>
  </link>
  <joint name="spin" type="continuous">
    <parent link="base"/><child link="board"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="turntable"/><origin xyz="1.2 0 2.9"/><axis xyz="0 0 1"/>
  </joint>
</robot>
)";

class LiveTargetsTest : public testing::Test {
 protected:
  LiveTargetsTest() {
    for (std::size_t i = 0; i < bench_.inbox.topics().size(); ++i)
      if (bench_.inbox.topics()[i].role == io::LiveRole::targets)
        bench_.inbox.set_type(i, "geometry_msgs/msg/PoseStamped");
  }
  static io::LiveOptions options() {
    io::LiveOptions options = LiveBench::one_camera();
    options.target_topics = {"/wrist"};
    return options;
  }
  /// The camera's frame is known by its first image.
  void tell_camera() {
    bench_.tell_mount();
    bench_.tell_info(0);
    bench_.tell_depth(start - seconds);
  }
  void tell_target(std::int64_t stamp, const std::string& frame, const Eigen::Vector3d& position) {
    io::PoseStampedMessage pose{.header = {stamp, frame}};
    pose.pose.translation() = position;
    bench_.tell("/wrist", encoded(pose));
  }
  /// All joints, by so many programs that see the turntable turned differently.
  void tell_states(std::int64_t first, std::int64_t last, std::uint64_t programs) {
    for (std::int64_t t = first; t <= last; t += 10 * milliseconds)
      for (std::uint64_t program = 0; program < programs; ++program)
        bench_.tell("/joint_states",
                    encoded(io::JointStateMessage{
                        .header = {t, ""},
                        .names = {"spin", "turn"},
                        .positions = {spin_at(t), 0.5 * static_cast<double>(program)}}),
                    7 + program);
  }
  io::TargetsMessage judge(std::int64_t stamp) {
    bench_.tell_depth(stamp);
    EXPECT_EQ(bench_.work(), 1U);
    return bench_.results.last<io::TargetsMessage>(io::Result::targets);
  }

  LiveBench bench_{options()};
  LiveTruth truth_;
};

TEST_F(LiveTargetsTest, ComeWithTheNextImage) {
  bench_.tell_robot();
  tell_camera();
  tell_target(start, "optical", {1.2, 0.0, 3.0});
  bench_.tell_joints(start);
  const auto targets = judge(start);
  ASSERT_EQ(targets.targets.size(), 1U);
  EXPECT_EQ(targets.targets[0].name, "/wrist");
  EXPECT_EQ(targets.targets[0].verdict, io::TargetMessage::visible);
}

/// The robot that is drawn is where all say that it is, so that its labels are true.
TEST_F(LiveTargetsTest, InALinkThatTwoProgramsPutElsewhereAreUnknown) {
  bench_.tell_robot(turntable_urdf);
  tell_camera();
  tell_states(start - 300 * milliseconds, start + 20 * milliseconds, 1);
  tell_target(start, "turntable", {0.0, 0.0, 0.1});
  auto told = judge(start);
  ASSERT_EQ(told.targets.size(), 1U);
  EXPECT_EQ(told.targets[0].verdict, io::TargetMessage::visible) << told.targets[0].reason;

  const std::int64_t later = start + 2 * seconds;
  tell_states(later - 300 * milliseconds, later + 20 * milliseconds, 2);
  bench_.results.published.clear();
  tell_target(later, "turntable", {0.0, 0.0, 0.1});
  told = judge(later);
  EXPECT_EQ(told.status, "ok");
  EXPECT_EQ(expect_true_labels(bench_.results.published, truth_), 1U);
  ASSERT_EQ(told.targets.size(), 1U);
  EXPECT_EQ(told.targets[0].verdict, io::TargetMessage::unknown);
  for (const char* const part : {"'turntable'", "joint 'turn' is at "})
    EXPECT_NE(told.targets[0].reason.find(part), std::string::npos) << told.targets[0].reason;
}

TEST_F(LiveTargetsTest, OfAnImageThatFailsAreCounted) {
  bench_.tell_robot("<robot name=\"bare\"><link name=\"base\"/></robot>");
  tell_camera();
  tell_target(start, "optical", {1.2, 0.0, 3.0});
  bench_.tell_depth(start);
  ASSERT_EQ(bench_.work(), 1U);
  EXPECT_EQ(bench_.counts().failed, 1U);
  EXPECT_NE(bench_.inbox.tally(0).last.fault.find("no link is drawn"), std::string::npos);
  EXPECT_EQ(bench_.inbox.camera(0).targets().discarded, 1U);
}

}  // namespace
}  // namespace penumbra::test
