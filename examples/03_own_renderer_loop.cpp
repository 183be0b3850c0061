// SPDX-License-Identifier: Apache-2.0
// A loop of one's own: images come 20 ms late and are rendered with the joints of their own stamp.
#include <iostream>
#include <vector>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/time/joint_buffer.hpp>

#include <io/files/recording.hpp>

using namespace penumbra;

int main(int argc, char** argv) try {
  const auto recording = io::Recording::open(argc > 1 ? argv[1] : "examples/arm_over_table");
  const Camera& camera = recording.camera.camera;
  const Robot robot = recording.load_robot();
  const auto renderer = make_depth_renderer(Backend::cpu, camera.intrinsics, bodies_of(robot));
  std::vector<double> positions = robot.rest_positions();
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  JointBuffer buffer(robot, {.max_gap = 0.05});
  JointAnswer joints;
  for (std::int64_t now = 0; now < 3'000'000'000; now += 10'000'000) {  // nanoseconds
    positions[0] = 1e-9 * static_cast<double>(now);  // the driver breaks off for 0.6 s
    if (now < 1e9 || now > 1.6e9) buffer.insert(now, robot.variables(), positions);
    if (now % 300'000'000 != 200'000'000) continue;
    buffer.at(now - 20'000'000, joints);
    if (joints.status != JointStatus::ok) {  // the robot is never drawn at an old pose
      std::cout << describe(robot, joints) << '\n';
      continue;
    }
    robot.forward_kinematics(joints.positions, poses);
    for (auto& pose : poses) pose = camera.pose().inverse() * pose;  // T_camera_link
    const VirtualDepthView view = renderer->render(poses);
    std::cout << "shoulder " << view.depth(260, 230) << " m away\n";
  }
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
