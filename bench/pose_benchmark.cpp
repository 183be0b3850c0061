// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of what it costs to know where a robot was: one lookup of a transform along a
// chain, and of all links by joint states, by TF and by both, in ten seconds of states at 125 Hz;
// and to take a joint state, of one publisher or of two of the same joints.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <penumbra/pipeline/frame_queue.hpp>

namespace penumbra::bench {
namespace {

constexpr int joints = 7;
constexpr std::int64_t period = 8'000'000;  // nanoseconds
constexpr int states = 1250;

std::string link_name(int i) { return "shoulder_or_wrist_link_" + std::to_string(i); }
std::string joint_name(int i) { return "shoulder_or_wrist_joint_" + std::to_string(i); }

Robot arm() {
  std::string urdf = "<robot name=\"arm\"><link name=\"" + link_name(0) + "\"/>";
  for (int i = 1; i <= joints; ++i)
    urdf += "<link name=\"" + link_name(i) +
            "\"><collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>"
            "<joint name=\"" +
            joint_name(i) + "\" type=\"continuous\"><parent link=\"" + link_name(i - 1) +
            "\"/><child link=\"" + link_name(i) +
            "\"/><origin xyz=\"0 0 0.2\" rpy=\"1.57 0 0\"/><axis xyz=\"0 0 1\"/></joint>";
  return Robot::parse(urdf + "</robot>", ".");
}

std::vector<std::string> joint_names() {
  std::vector<std::string> names;
  for (int i = 1; i <= joints; ++i) names.push_back(joint_name(i));
  return names;
}

struct Filled {
  Robot robot = arm();
  PoseHistory history{robot};

  explicit Filled(bool by_two = false) {
    const std::vector<std::string> names = joint_names();
    std::vector<Eigen::Isometry3d> poses(robot.links().size());
    for (int s = 1; s <= states; ++s) {
      const std::vector<double> positions(joints, std::sin(0.01 * s));
      history.add_joints(s * period, names, positions, "a");
      if (by_two) history.add_joints(s * period + period / 2, names, positions, "b");
      robot.forward_kinematics(positions, poses);
      for (int i = 1; i <= joints; ++i)
        history.add_transform(
            s * period, link_name(i - 1), link_name(i),
            poses[static_cast<std::size_t>(i - 1)].inverse() * poses[static_cast<std::size_t>(i)]);
    }
    history.add_static_transform(link_name(0), "camera", Eigen::Isometry3d::Identity());
  }
};

std::int64_t stamp_of(std::int64_t i) { return (i % (states - 2) + 1) * period + period / 3; }

void chain(benchmark::State& state) {
  const Filled filled;
  TransformAnswer answer;
  const std::string tool = link_name(joints);
  std::int64_t i = 0;
  for (auto _ : state) {
    filled.history.transforms().at(stamp_of(i++ * 37), "camera", tool, answer);
    benchmark::DoNotOptimize(answer.T_target_source);
  }
}
BENCHMARK(chain)->Name("transform along 8 frames");

void links(benchmark::State& state, PoseSource source, bool by_two) {
  const Filled filled(by_two);
  PoseLookup lookup(filled.robot, {.source = source, .camera_frame = "camera"});
  PoseAnswer answer;
  std::int64_t i = 0;
  for (auto _ : state) {
    lookup.at(filled.history, stamp_of(i++ * 37), answer);
    if (answer.status != FrameStatus::ok) state.SkipWithError(answer.message.c_str());
  }
}
BENCHMARK_CAPTURE(links, joints, PoseSource::joints, false)
    ->Name("all links and the camera, by joints");
BENCHMARK_CAPTURE(links, two, PoseSource::joints, true)
    ->Name("all links and the camera, by joints of two publishers");
BENCHMARK_CAPTURE(links, tf, PoseSource::transforms, false)
    ->Name("all links and the camera, by TF");
BENCHMARK_CAPTURE(links, both, PoseSource::both, false)->Name("all links and the camera, by both");

/// 125 Hz each, moving.
void take(benchmark::State& state, bool by_two) {
  const Robot robot = arm();
  PoseHistory history(robot);
  const std::vector<std::string> names = joint_names();
  std::vector<double> positions(joints);
  std::int64_t i = 1;
  for (auto _ : state) {
    const std::int64_t stamp = i * (by_two ? period / 2 : period);
    for (double& position : positions) position = std::sin(1e-9 * static_cast<double>(stamp));
    benchmark::DoNotOptimize(
        history.add_joints(stamp, names, positions, by_two && i % 2 == 0 ? "b" : "a"));
    ++i;
  }
}
BENCHMARK_CAPTURE(take, one, false)->Name("a joint state taken, of one publisher");
BENCHMARK_CAPTURE(take, two, true)->Name("a joint state taken, of two publishers");

}  // namespace
}  // namespace penumbra::bench

BENCHMARK_MAIN();
