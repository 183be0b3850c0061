// SPDX-License-Identifier: Apache-2.0
// Each stage on its own: kinematics, renderer and labels need neither each other nor a pipeline.
#include <cmath>
#include <iostream>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

using namespace penumbra;

namespace {

/// A camera at `eye` that looks at `target`, with z up in the world: T_world_camera.
Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

/// Stands in for a sensor: sees the robot, and a plate of 80 x 80 pixels 20 cm before `at`.
Image<float> measure(const VirtualDepthView& robot, const Eigen::Vector2d& at, double z) {
  Image<float> depth(robot.depth.width, robot.depth.height);
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      const bool plate = std::abs(u - at.x()) <= 40 && std::abs(v - at.y()) <= 40;
      depth(u, v) = plate ? static_cast<float>(z - 0.2) : robot.depth(u, v);
    }
  }
  return depth;
}

void run(const std::filesystem::path& folder) {
  // Kinematics: where is every link?
  const Robot robot = Robot::load(folder / "arm.urdf", {.packages = {{"arm_description", folder}}});
  std::vector<double> positions = robot.rest_positions();
  positions[robot.find_variable("shoulder_lift").value()] = 0.6;
  positions[robot.find_variable("elbow").value()] = 1.2;
  std::vector<Eigen::Isometry3d> T_base_link(robot.links().size());
  robot.forward_kinematics(positions, T_base_link);
  const Eigen::Vector3d elbow = T_base_link[robot.find_link("forearm").value()].translation();
  std::cout << "elbow at " << elbow.transpose() << " m\n";

  // Renderer: what would a camera see of it?
  const Intrinsics intrinsics(640, 480, 610.0, 610.0, 322.5, 236.0);
  const auto renderer = make_depth_renderer(Backend::cpu, intrinsics, bodies_of(robot));

  const Eigen::Isometry3d T_camera_base = look_at({1.2, -1.0, 0.8}, {0.2, 0.0, 0.3}).inverse();
  std::vector<Eigen::Isometry3d> T_camera_link = T_base_link;
  for (auto& T : T_camera_link) T = T_camera_base * T;
  const VirtualDepthView virtual_depth = renderer->render(T_camera_link);

  // Labels: what do measured depths mean?
  const Eigen::Vector3d seen = T_camera_base * elbow;
  const Image<float> depth = measure(virtual_depth, intrinsics.project(seen), seen.z());
  Classifier classifier(intrinsics.width(), intrinsics.height(), LabelRule{});
  const LabelView labels = classifier.classify(virtual_depth, depth.view());
  const auto count = [&](Label label) { return labels.pixels[static_cast<std::size_t>(label)]; };
  std::cout << "front " << count(Label::front) << ", occluded " << count(Label::occluded)
            << ", unknown " << count(Label::unknown) << " pixels\n";
}

}  // namespace

int main(int argc, char** argv) try {
  run(argc > 1 ? argv[1] : "examples/arm_over_table/arm_description");
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
