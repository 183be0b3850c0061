// SPDX-License-Identifier: Apache-2.0
// Each stage on its own: kinematics, renderer and labels need neither each other nor a pipeline.
#include <iostream>
#include <vector>

#include <penumbra/labels/labels.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

using namespace penumbra;

int main(int argc, char** argv) try {
  const auto recording = io::Recording::open(argc > 1 ? argv[1] : "examples/arm_over_table");
  const Camera& camera = recording.camera.camera;
  const Robot robot = recording.load_robot();
  const Frame frame = io::FrameReader(recording, robot).read(6, /*with_color=*/false);

  // Kinematics: where is every link?
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(frame.pose.positions, poses);
  for (auto& pose : poses) pose = camera.pose().inverse() * pose;  // T_camera_link

  // Renderer: what does the camera see of them?
  const auto renderer = make_depth_renderer(Backend::cpu, camera.intrinsics, bodies_of(robot));
  const VirtualDepthView virtual_depth = renderer->render(poses);

  // Labels: what do measured depths mean?
  Classifier classifier(camera.intrinsics.width(), camera.intrinsics.height(), LabelRule{});
  const LabelView labels = classifier.classify(virtual_depth, frame.depth.view);
  const auto count = [&](Label label) { return labels.pixels[static_cast<std::size_t>(label)]; };
  std::cout << "front " << count(Label::front) << ", occluded " << count(Label::occluded) << '\n';
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
