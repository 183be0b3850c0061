// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <research/robot_distance.hpp>
#include <research/run.hpp>

namespace penumbra::research {
namespace {

constexpr double reached_distance = 0.05;  // metres
constexpr double body_distance = 0.03;     // metres from the robot's surface that are on it
constexpr double wrist_margin = 0.05;      // metres above the wrist

class HandoverRun : public Run {
 public:
  HandoverRun(std::uint64_t seed, const RunSettings& settings)
      : Run("handover", "wrist", seed, settings) {}

 protected:
  std::vector<Lane> make_lanes(const sim::SimFrame& /*first*/, std::uint64_t seed) override {
    keypoints_.emplace(cell_, seed, settings_.keypoint_sigma);
    std::vector<Lane> lanes;
    lanes.push_back(
        {{"keypoint", "Wrist key point of a pose network", {}}, make_point_methods(cell_)});
    return lanes;
  }

  std::vector<std::optional<View>> perceive(const sim::SimFrame& frame,
                                            const Observation& observed) override {
    const auto keypoint = keypoints_->detect(frame);
    if (!keypoint) return {std::nullopt};
    const double height = object_named(frame, "wrist").T_base_object.translation().z();
    return {View{.observed = observed, .plane = height + wrist_margin, .keypoint = *keypoint}};
  }

  /// A point is the robot's, however near the wrist is, if it is nearer to the robot's true surface
  /// than to the wrist's.
  bool is_on_robot(const Eigen::Vector3d& surface, const sim::SimFrame& frame,
                   const TargetTruth& truth) const override {
    const double to_wrist = std::abs((surface - truth.pose.translation()).norm() - wrist_radius);
    const auto to_robot =
        distance_to_robot(pipeline_.robot(), frame.true_joints, surface, body_distance);
    return to_robot && *to_robot < to_wrist;
  }

  bool succeeds(const Sample& sample) const override {
    return sample.known && sample.translation_error < reached_distance;
  }

 private:
  std::optional<KeypointDetector> keypoints_;
};

}  // namespace

std::unique_ptr<Run> make_handover_run(std::uint64_t seed, const RunSettings& settings) {
  return std::make_unique<HandoverRun>(seed, settings);
}

}  // namespace penumbra::research
