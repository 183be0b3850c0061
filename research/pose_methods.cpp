// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <research/method.hpp>
#include <research/object_fit.hpp>
#include <research/robot_filters.hpp>

namespace penumbra::research {
namespace {

/// Estimates the object's pose in the base frame from the features in a mask.
struct Estimation {
  const Cell& cell;
  const PoseEstimator& estimator;
  Acceptance acceptance;

  std::optional<PoseEstimate> operator()(const View& view,
                                         ImageView<const std::uint8_t> mask) const {
    const auto guess = estimator.estimate(view.matches, mask, acceptance);
    if (!guess) return std::nullopt;
    PoseEstimate estimate{view.observed.stamp, cell.T_base_camera * guess->T_camera_object,
                          std::nullopt};
    if (!guess->covariance) return estimate;
    Matrix6d turn = Matrix6d::Zero();
    turn.topLeftCorner<3, 3>() = cell.T_base_camera.linear();
    turn.bottomRightCorner<3, 3>() = cell.T_base_camera.linear();
    estimate.covariance = Matrix6d(turn * *guess->covariance * turn.transpose());
    return estimate;
  }

  /// From the whole detected region.
  std::optional<PoseEstimate> operator()(const View& view) const {
    return (*this)(view, view.detection.mask.view());
  }
};

/// The object hides what is measured well in front of its own predicted surface (Wuethrich 2013):
/// these pixels are removed.
Answer look_by_object_model(const Estimation& estimate, const View& view,
                            const Follower& follower) {
  constexpr double tolerance = 0.02;  // metres
  const TrackedPose predicted = follower.at(view.observed.stamp);
  if (predicted.source == Source::lost) return {estimate(view)};
  const Cell& cell = estimate.cell;
  const Eigen::Isometry3d T_object_camera = predicted.pose.inverse() * cell.T_base_camera;
  const auto rest = mask_without(view.detection, [&](int u, int v) {
    const std::uint16_t depth = view.observed.depth(u, v);
    const double expected =
        box_depth(T_object_camera, cell.object_size, cell.camera.intrinsics.ray(u, v));
    return depth != 0 && depth * metres_per_unit < expected - tolerance;
  });
  return {estimate(view, rest.view())};
}

/// Points of both depth cameras are fitted near the predicted pose (after Fetzner 2014). The fit
/// replaces estimates that it contradicts.
Answer look_by_two_clouds(const Estimation& estimate, const View& view, const Follower& follower) {
  constexpr double most_apart = 0.02;  // metres
  const auto color = estimate(view);
  const TrackedPose predicted = follower.at(view.observed.stamp);
  if (predicted.source == Source::lost) return {color};
  const auto fitted = fit_object(estimate.cell, view.observed, predicted.pose);
  const bool agree = color && fitted &&
                     (color->pose.translation() - fitted->pose.translation()).norm() <= most_apart;
  return {agree || !fitted ? color : fitted};
}

/// Penumbra's judgement of the detected region.
class RegionJudge {
 public:
  explicit RegionJudge(const Cell& cell)
      : cell_(cell), judge_(cell.camera, cell.rule, cell.links) {}

  Judgement operator()(const View& view, const Follower& follower) {
    TargetView target;
    target.region = PixelMask{view.detection.mask.view()};
    target.extent = view.detection.extent;
    target.motion = motion_since_visible(view.observed.stamp, follower);
    judge_.begin(view.observed.robot);
    const Judgement judgement = judge_.judge(target, memory_);
    if (judgement.verdict == Verdict::visible) last_visible_ = view.observed.stamp;
    return judgement;
  }

 private:
  /// Returns how far the object's origin has moved in the image since it was last visible, pixels.
  std::optional<Eigen::Vector2d> motion_since_visible(std::int64_t stamp,
                                                      const Follower& follower) const {
    if (!last_visible_) return std::nullopt;
    const TrackedPose before = follower.at(*last_visible_), now = follower.at(stamp);
    if (before.source == Source::lost || now.source == Source::lost) return std::nullopt;
    const auto pixel = [&](const TrackedPose& pose) {
      return cell_.camera.intrinsics.project(cell_.T_base_camera.inverse() *
                                             pose.pose.translation());
    };
    return pixel(now) - pixel(before);
  }

  const Cell& cell_;
  TargetJudge judge_;
  TargetMemory memory_;
  std::optional<std::int64_t> last_visible_;
};

/// Returns the mask's pixels that are labelled clear or front.
Image<std::uint8_t> trusted_mask(const View& view) {
  const auto& labels = view.observed.robot.labels.labels;
  return mask_without(view.detection, [&](int u, int v) {
    const Label label{labels(u, v)};
    return label != Label::clear && label != Label::front;
  });
}

}  // namespace

std::vector<Method> make_pose_methods(const Cell& cell, const PoseEstimator& estimator,
                                      Acceptance acceptance) {
  PoseTrackerConfig tracker;  // knows the conveyor's direction, not its speed
  tracker.motion = Motion::along_direction;
  tracker.direction = cell.conveyor_direction;
  PoseTrackerConfig takes_partial = tracker;
  takes_partial.worst = Verdict::partial;
  const Estimation estimate{cell, estimator, acceptance};

  const auto whole = [=](const View& view, const Follower&) { return Answer{estimate(view)}; };
  std::vector<Method> methods;
  methods.push_back({"raw", "No handling", make_last_estimate(), whole});
  methods.push_back({"tracker", "Tracker alone", make_follower(tracker), whole});
  for (const RobotFilter& filter : robot_filters) {
    const auto filtered = [=](const View& view, const Follower&) {
      const auto rest = mask_without(
          view.detection, [&](int u, int v) { return filter.removes(estimate.cell, view, u, v); });
      return Answer{estimate(view, rest.view())};
    };
    const std::string key = filter.key, name = filter.name;
    methods.push_back({key + "_raw", name, make_last_estimate(), filtered});
    methods.push_back({key, name + " + tracker", make_follower(tracker), filtered});
  }
  methods.push_back({"own_model", "Object's own model + tracker", make_follower(tracker),
                     std::bind_front(look_by_object_model, estimate)});
  methods.push_back({"two_cameras", "Second camera + tracker", make_follower(tracker),
                     std::bind_front(look_by_two_clouds, estimate)});
  for (const bool partial : {true, false}) {
    const auto judge = std::make_shared<RegionJudge>(cell);
    methods.push_back({partial ? "penumbra_partial" : "penumbra",
                       partial ? "Penumbra, partial" : "Penumbra",
                       make_follower(partial ? takes_partial : tracker),
                       [=](const View& view, const Follower& follower) {
                         const Judgement judged = (*judge)(view, follower);
                         if (partial)
                           return Answer{estimate(view, trusted_mask(view).view()), judged.verdict};
                         Answer answer{estimate(view), judged.verdict};
                         if (answer.estimate) answer.estimate->seen = judged.clear + judged.front;
                         return answer;
                       }});
  }
  return methods;
}

}  // namespace penumbra::research
