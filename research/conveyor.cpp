// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include <research/run.hpp>

namespace penumbra::research {
namespace {

constexpr double grasp_distance = 0.01;             // metres
constexpr double grasp_angle = 5.0 * M_PI / 180.0;  // radians
constexpr double object_margin = 0.03;              // metres above the object's top

PixelBox box_around(const PixelBox& a, const PixelBox& b) {
  const double u = std::min(a.u, b.u), v = std::min(a.v, b.v);
  return {u, v, std::max(a.u + a.width, b.u + b.width) - u,
          std::max(a.v + a.height, b.v + b.height) - v};
}

class ConveyorRun : public Run {
 public:
  ConveyorRun(std::uint64_t seed, const RunSettings& settings)
      : Run("conveyor", "parcel", seed, settings),
        estimator_(cell_.camera, simulation_.model_image().view(), cell_.object_size) {}

 protected:
  std::vector<Lane> make_lanes(const sim::SimFrame& first, std::uint64_t seed) override {
    cell_.belt_height =
        object_named(first, "parcel").T_base_object.translation().z() - 0.5 * cell_.object_size.z();
    amodal_.emplace(cell_, seed);
    modal_.emplace(seed);
    const auto lane = [&](const char* key, const char* name, Acceptance acceptance) {
      return Lane{{key, name, {}}, make_pose_methods(cell_, estimator_, acceptance)};
    };
    std::vector<Lane> lanes;
    lanes.push_back(lane("amodal", "Detector of full extents (amodal), careful estimator",
                         Acceptance::careful));
    lanes.push_back(lane("modal", "Detector of visible pixels (modal), careful estimator",
                         Acceptance::careful));
    lanes.push_back(lane("amodal_eager", "Detector of full extents (amodal), eager estimator",
                         Acceptance::eager));
    lanes.push_back(lane("modal_eager", "Detector of visible pixels (modal), eager estimator",
                         Acceptance::eager));
    return lanes;
  }

  std::vector<std::optional<View>> perceive(const sim::SimFrame& frame,
                                            const Observation& observed) override {
    const auto amodal = amodal_->detect(frame), modal = modal_->detect(frame);
    matches_.clear();
    if (amodal || modal) {
      const PixelBox& one = amodal ? amodal->box : modal->box;
      matches_ =
          estimator_.match(frame.color.view(), box_around(one, modal ? modal->box : amodal->box));
    }
    const auto view = [&](const std::optional<Detection>& detection) -> std::optional<View> {
      if (!detection) return std::nullopt;
      return View{.observed = observed,
                  .plane = cell_.belt_height + cell_.object_size.z() + object_margin,
                  .detection = *detection,
                  .matches = matches_};
    };
    return {view(amodal), view(modal), view(amodal), view(modal)};
  }

  bool is_on_robot(const Eigen::Vector3d& /*surface*/, const sim::SimFrame& /*frame*/,
                   const TargetTruth& /*truth*/) const override {
    return false;
  }

  bool succeeds(const Sample& sample) const override {
    return sample.known && sample.translation_error < grasp_distance &&
           sample.rotation_error < grasp_angle;
  }

 private:
  PoseEstimator estimator_;
  std::optional<AmodalDetector> amodal_;
  std::optional<ModalDetector> modal_;
  std::vector<FeatureMatch> matches_;  // of the last frame
};

}  // namespace

std::unique_ptr<Run> make_conveyor_run(std::uint64_t seed, const RunSettings& settings) {
  return std::make_unique<ConveyorRun>(seed, settings);
}

}  // namespace penumbra::research
