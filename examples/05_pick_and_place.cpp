// SPDX-License-Identifier: Apache-2.0
// A part is picked up and put down: attach_target() when the gripper closes, nothing when it opens.
#include <iostream>

#include <penumbra/session/session.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

using namespace penumbra;

int main(int argc, char** argv) try {
  const auto recording = io::Recording::open(argc > 1 ? argv[1] : "examples/arm_over_table");
  const Robot robot = recording.load_robot();
  const std::size_t gripper = robot.find_link("gripper").value();
  const io::FrameReader frames(recording, robot);
  PipelineConfig config;
  config.has_depth = false;  // the images do not show this part
  Session session(robot, recording.camera.camera, config);
  BoxTarget box{.size = {0.06, 0.06, 0.12}, .frame = ReferenceFrame::root()};  // metres
  box.pose.translation() << 0.634, -0.041, 0.22;  // where a detector found it
  RobotPose pose;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Target part{.name = "part", .shape = box, .handling = PoseTrackerConfig{}};
    const Frame frame = frames.read(i, /*with_color=*/false);
    pose.positions = frame.pose.positions;
    const FrameReport& report =
        session.process({.stamp = frame.stamp, .pose = pose, .targets = {part}});
    const TargetReport& target = report.targets[0];
    std::cout << "frame " << i << ": " << to_string(target.verdict) << ' ' << target.reason << '\n';

    if (i == 3) pose.attached = {session.pipeline().attach_target(part, "gripper")};
    if (i == 8) box.pose = report.T_root_link[gripper] * pose.attached[0].T_link_body;
    if (i == 8) pose.attached.clear();
  }
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
