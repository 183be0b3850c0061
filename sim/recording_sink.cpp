// SPDX-License-Identifier: Apache-2.0
#include <sim/numbers.hpp>
#include <sim/recording_sink.hpp>

namespace penumbra::sim {
namespace {

std::string list(const Eigen::Vector3d& v) {
  return "[" + numbers({v.x(), v.y(), v.z()}, ", ") + "]";
}

}  // namespace

std::string scene_text(const Simulation& simulation, const std::string& scene,
                       const SimulationOptions& options) {
  const DepthNoise& depth = options.depth;
  std::string text =
      "scene: " + scene + "\nseed: " + std::to_string(options.seed) +
      "\nduration: " + numbers({simulation.duration()}) +
      "\nframe_rate: " + numbers({options.frame_rate}) +
      "\njoint_sigma: " + numbers({options.joint_sigma}) +
      "\njoint_latency: " + numbers({options.joint_latency}) +
      "\nbelt_jitter: " + numbers({options.belt_jitter}) +
      "\ndepth_noise: {quadratic: " + numbers({depth.quadratic}) +
      ", disparity_step: " + numbers({depth.disparity_step}) +
      ", baseline: " + numbers({depth.baseline}) + ", edge_holes: " + numbers({depth.edge_holes}) +
      ", edge_mixed: " + numbers({depth.edge_mixed}) +
      ", edge_width: " + numbers({depth.edge_width}) + ", holes: " + numbers({depth.holes}) + "}\n";
  if (!simulation.model_image().empty())
    text += "object_size: " + list(simulation.object_size()) +
            "   # metres; the model image is on the +z face\n" +
            "conveyor_direction: " + list(simulation.conveyor_direction()) + '\n';
  if (const auto grasp = simulation.grasp_stamp())
    text += "grasp_stamp: " + std::to_string(*grasp) + '\n';
  return text;
}

void store_ids(const SimFrame& frame, Image<std::uint16_t>& to) {
  to.fit(frame.ids.width(), frame.ids.height());
  for (std::size_t i = 0; i < to.size(); ++i)
    to.data()[i] = static_cast<std::uint16_t>(frame.ids.data()[i]);
}

}  // namespace penumbra::sim
