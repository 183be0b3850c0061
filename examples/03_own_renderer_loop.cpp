// SPDX-License-Identifier: Apache-2.0
// A loop of one's own: joint states arrive at 100 Hz, the camera moves, and every frame is rendered
// with the joints of its own stamp.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/joint_buffer.hpp>

using namespace penumbra;

namespace {

constexpr std::int64_t second = 1'000'000'000;  // nanoseconds
constexpr std::int64_t joint_period = second / 100;
constexpr std::int64_t frame_period = second / 30;
constexpr int frames = 90;

/// Stands in for a driver: two joints of the arm swing.
void receive_joints(std::int64_t stamp, const Robot& robot, JointBuffer& buffer) {
  const double t = static_cast<double>(stamp) / static_cast<double>(second);
  std::vector<double> positions = robot.rest_positions();
  positions[robot.find_variable("shoulder_pan").value()] = std::sin(t);
  positions[robot.find_variable("elbow").value()] = 1.2 + 0.3 * std::cos(2.0 * t);
  buffer.insert(stamp, robot.variables(), positions);
}

/// Stands in for a tracker: a camera that circles the base and looks at it. T_camera_base.
Eigen::Isometry3d camera_pose(std::int64_t stamp) {
  const double angle = 0.2 * static_cast<double>(stamp) / static_cast<double>(second);
  const Eigen::Vector3d eye(1.6 * std::cos(angle), 1.6 * std::sin(angle), 0.7);
  const Eigen::Vector3d z = (Eigen::Vector3d(0.0, 0.0, 0.3) - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.linear() << x, z.cross(x), z;
  T_base_camera.translation() = eye;
  return T_base_camera.inverse();
}

void run(const std::filesystem::path& folder) {
  const Robot robot = Robot::load(folder / "arm.urdf", {.packages = {{"arm_description", folder}}});
  const Intrinsics intrinsics(1280, 720, 915.0, 915.0, 641.5, 362.0);
  const auto renderer = make_depth_renderer(Backend::cpu, intrinsics, bodies_of(robot));

  JointBuffer buffer(robot, {.max_gap = 0.05});
  JointAnswer joints;
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::vector<double> times;
  int stale = 0;
  std::int64_t received = 0;
  for (int i = 0; i < frames; ++i) {
    const std::int64_t stamp = i * frame_period;
    // The driver breaks off for a while: those frames must be refused, not drawn at an old pose.
    for (; received <= stamp + joint_period; received += joint_period)
      if (i < 40 || i >= 50) receive_joints(received, robot, buffer);

    buffer.at(stamp, joints);
    if (joints.status != JointStatus::ok) {
      ++stale;
      continue;
    }
    robot.forward_kinematics(joints.positions, poses);
    const Eigen::Isometry3d T_camera_base = camera_pose(stamp);
    for (auto& pose : poses) pose = T_camera_base * pose;
    const auto start = std::chrono::steady_clock::now();
    const VirtualDepthView view = renderer->render(poses);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    times.push_back(time.count());
    if (i == 0) std::cout << "first frame " << view.depth.width << "x" << view.depth.height << '\n';
  }
  std::sort(times.begin(), times.end());
  std::cout << times.size() << " frames rendered, " << stale << " refused: joints stale\n"
            << "render, median: " << times[times.size() / 2] << " ms\n";
}

}  // namespace

int main(int argc, char** argv) try {
  run(argc > 1 ? argv[1] : "examples/arm_over_table/arm_description");
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
