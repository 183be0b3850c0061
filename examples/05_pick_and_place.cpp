// SPDX-License-Identifier: Apache-2.0
// A part is picked up and put down: attach_target() when the gripper closes, nothing when it opens.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/session/session.hpp>

using namespace penumbra;

namespace {

constexpr int closes = 30, opens = 90, frames = 120;  // when the gripper does
constexpr std::int64_t frame_period = 33'000'000;     // nanoseconds
const Eigen::Vector3d part_size(0.12, 0.10, 0.30);    // metres

/// A camera that looks at the arm from the side, with z up: T_base_camera.
Eigen::Isometry3d camera_pose() {
  const Eigen::Vector3d eye(1.7, -1.2, 1.1);
  const Eigen::Vector3d z = (Eigen::Vector3d(0.4, 0.0, 0.4) - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

/// The arm comes, swings to the side with the part, and leaves.
std::vector<double> joints_at(int frame, const Robot& robot) {
  const auto done = [&](int from, int to) {
    return std::clamp(static_cast<double>(frame - from) / (to - from), 0.0, 1.0);
  };
  std::vector<double> positions = robot.rest_positions();
  positions[robot.find_variable("shoulder_lift").value()] = 0.6;
  positions[robot.find_variable("elbow").value()] =
      0.6 + 0.6 * done(0, closes) - 0.6 * done(opens, frames);
  positions[robot.find_variable("shoulder_pan").value()] = 0.5 - done(closes, opens);
  return positions;
}

/// Stands in for a sensor: renders the robot and the part in front of a wall.
class Sensor {
 public:
  Sensor(const Intrinsics& intrinsics, const Robot& robot)
      : part_(make_box(part_size)), depth_(intrinsics.width(), intrinsics.height()) {
    std::vector<Body> all = bodies_of(robot);
    all.push_back({"part", {&part_, 1}});
    renderer_ = make_depth_renderer(Backend::cpu, intrinsics, all);
  }

  DepthView measure(const std::vector<Eigen::Isometry3d>& T_base_body) {
    std::vector<Eigen::Isometry3d> poses;
    for (const auto& T : T_base_body) poses.push_back(camera_pose().inverse() * T);
    seen_ = renderer_->render(poses);
    for (int v = 0; v < depth_.height(); ++v)
      for (int u = 0; u < depth_.width(); ++u)
        depth_(u, v) = seen_.depth(u, v) > 0 ? seen_.depth(u, v) : 3.0F;
    return depth_.view();
  }

  /// Returns how many pixels of the part are labelled clear or front, so that its points would stay
  /// in the cloud of what the robot does not carry.
  [[nodiscard]] std::size_t left_over(ImageView<const std::uint8_t> labels,
                                      std::size_t part) const {
    std::size_t count = 0;
    for (int v = 0; v < labels.height; ++v)
      for (int u = 0; u < labels.width; ++u)
        if (seen_.links(u, v) == part && is_trusted(static_cast<Label>(labels(u, v)))) ++count;
    return count;
  }

 private:
  PreparedMesh part_;
  std::unique_ptr<DepthRenderer> renderer_;
  Image<float> depth_;
  VirtualDepthView seen_;
};

void run(const std::filesystem::path& folder, bool attaches) {
  const Robot robot = Robot::load(folder / "arm.urdf", {.packages = {{"arm_description", folder}}});
  const std::size_t gripper = robot.find_link("gripper").value();
  const Camera camera{.intrinsics = Intrinsics(640, 480, 610.0, 610.0, 322.5, 236.0),
                      .T_parent_camera = camera_pose()};
  Session session(robot, camera);
  Sensor sensor(camera.intrinsics, robot);

  const Eigen::Isometry3d T_gripper_part(Eigen::Translation3d(0.0, 0.0, 0.22));
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(joints_at(closes, robot), poses);
  Eigen::Isometry3d T_base_part = poses[gripper] * T_gripper_part;

  std::vector<AttachedBody> attached;
  std::size_t left = 0;  // pixels of the carried part that seem not to be the robot's
  double most = 0.0;
  for (int i = 0; i < frames; ++i) {
    const std::vector<double> joints = joints_at(i, robot);
    robot.forward_kinematics(joints, poses);
    if (i > closes && i <= opens) T_base_part = poses[gripper] * T_gripper_part;
    std::vector<Eigen::Isometry3d> all = poses;
    all.push_back(T_base_part);

    const Target part{.name = "part",
                      .shape = BoxTarget{T_base_part, part_size, ReferenceFrame::root()},
                      .handling = PoseTrackerConfig{.motion = Motion::still}};
    const FrameReport& report =
        session.process({.stamp = i * frame_period,
                         .depth = sensor.measure(all),
                         .pose = {.positions = joints, .attached = attached},
                         .targets = {part}});
    const TargetReport& target = report.targets[0];
    if (i > closes && i <= opens) left += sensor.left_over(report.labels, all.size());
    if (target.verdict == Verdict::held)
      most = std::max(most, (*target.handled->position - T_base_part.translation()).norm());
    if (attaches && i % 15 == 0)
      std::cout << "frame " << i << ": " << to_string(target.verdict) << ' ' << target.reason
                << '\n';

    if (attaches && i == closes) attached = {session.pipeline().attach_target(part, "gripper")};
    if (i == opens) attached.clear();
  }
  std::cout << (attaches ? "attached" : "not attached") << ": while it is carried, " << left
            << " of its pixels are called clear or front";
  if (attaches)
    std::cout << "; its pose is off by at most " << std::round(1e6 * most) / 1e3 << " mm";
  std::cout << '\n';
}

}  // namespace

int main(int argc, char** argv) try {
  const std::filesystem::path folder =
      argc > 1 ? argv[1] : "examples/arm_over_table/arm_description";
  run(folder, true);
  run(folder, false);
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
