// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <sim/experiments/masks.hpp>
#include <sim/experiments/object_cloud.hpp>
#include <sim/experiments/pose_method.hpp>
#include <sim/experiments/robot_filters.hpp>

namespace penumbra::sim {
namespace {

constexpr double metres_per_unit = 1e-3;  // of a depth image
constexpr double height_margin = 0.03;    // metres above the object's top that are robot
constexpr double own_tolerance = 0.02;    // metres before the model's surface that are another's

/// The object's pose in the base frame as the estimator found it.
PoseEstimate to_base(const Cell& cell, std::int64_t stamp, const PoseGuess& guess) {
  PoseEstimate estimate{stamp, cell.T_base_camera * guess.T_camera_object, std::nullopt};
  if (!guess.covariance) return estimate;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = cell.T_base_camera.linear();
  turn.bottomRightCorner<3, 3>() = cell.T_base_camera.linear();
  estimate.covariance = Matrix6d(turn * *guess.covariance * turn.transpose());
  return estimate;
}

/// Height above the belt of what is measured at a pixel; nothing without measurement.
std::optional<double> height_at(const Cell& cell, const Sensed& sensed, int u, int v) {
  const std::uint16_t depth = sensed.depth(u, v);
  if (depth == 0) return std::nullopt;
  return surface_at(cell.camera.intrinsics, cell.T_base_camera, u, v, depth * metres_per_unit).z() -
         cell.floor;
}

/// The last estimate as it came, late as it is.
class RawPose : public PoseMethod {
 public:
  using PoseMethod::PoseMethod;
  MethodInfo info() const override {
    return {"raw", "No handling",
            "The last estimate that arrived, as it is: what a robot does without any handling."};
  }
  PoseAnswer look(const PoseView& view) override {
    return {estimate(view, view.detection.mask.view()), Verdict::visible};
  }
  Outcome take(const PoseAnswer& answer) override {
    if (!last_ || answer.estimate->stamp > last_->stamp) last_ = answer.estimate;
    return Outcome::accepted;
  }
  TrackedPose at(std::int64_t stamp) const override {
    TrackedPose pose;
    if (!last_) return pose;
    pose.source = Source::held;
    pose.age = static_cast<double>(stamp - last_->stamp) * 1e-9;
    pose.pose = last_->pose;
    return pose;
  }

 private:
  std::optional<PoseEstimate> last_;
};

/// Every estimate goes to the tracker, whose gate is all that refuses.
class TrackerAlone : public PoseMethod {
 public:
  using PoseMethod::PoseMethod;
  MethodInfo info() const override {
    return {
        "tracker", "Tracker alone",
        "Every estimate goes to the same tracker as in all methods below; only its outlier gate "
        "refuses."};
  }
  PoseAnswer look(const PoseView& view) override {
    return {estimate(view, view.detection.mask.view()), Verdict::visible};
  }
};

/// A way of taking the robot out of a detected region.
struct RegionFilter {
  const char* key;
  const char* name;
  const char* idea;
  bool (*removes)(const Cell& cell, const Sensed& sensed, int u, int v);
};

/// Points above a plane are robot (Yoshioka 2021).
constexpr RegionFilter height_region_filter{
    "height", "Height threshold",
    "Points more than 3 cm above the object's known top are robot and are taken from the region "
    "(Yoshioka 2021), with 3 pixels about them.",
    [](const Cell& cell, const Sensed& sensed, int u, int v) {
      return height_at(cell, sensed, u, v).value_or(0) > cell.object_size.z() + height_margin;
    }};

constexpr RegionFilter silhouette_region_filter{
    "silhouette", "Silhouette subtraction",
    "Every pixel on which the robot's model is drawn is taken from the region, with 3 pixels about "
    "it, also where something before the robot was measured; with the same renderer and joints as "
    "ours.",
    [](const Cell&, const Sensed& sensed, int u, int v) { return on_silhouette(sensed, u, v); }};

constexpr RegionFilter urdf_region_filter{
    "urdf_filter", "URDF filter",
    "Pixels on which the robot's model is drawn are taken from the region, with 3 pixels about "
    "them, where the measured depth lies beyond the drawn one less 5 cm: realtime_urdf_filter's "
    "rule with the threshold that it ships, with the same renderer and joints as ours.",
    [](const Cell&, const Sensed& sensed, int u, int v) { return urdf_filtered(sensed, u, v); }};

/// The estimate from what a filter leaves of the region; `Base` says who follows.
template <typename Base>
class FilteredPose : public Base {
 public:
  FilteredPose(const Cell& cell, const Perception& perception, const PoseTrackerConfig& tracker,
               const RegionFilter& filter)
      : Base(cell, perception, tracker), filter_(filter) {}
  MethodInfo info() const override {
    if (std::is_base_of_v<RawPose, Base>)
      return {filter_.key + std::string("_raw"), filter_.name,
              filter_.idea + std::string(" The last estimate from the rest, as it is.")};
    return {filter_.key, filter_.name + std::string(" + tracker"),
            "The same, and our tracker follows."};
  }
  PoseAnswer look(const PoseView& view) override {
    const auto rest = without(view.detection.mask, view.detection.box, [&](int u, int v) {
      return filter_.removes(this->cell(), view.sensed, u, v);
    });
    return {this->estimate(view, rest.view()), Verdict::visible};
  }

 private:
  RegionFilter filter_;
};

/// What is measured well before the object's own predicted surface is not the object (Wuethrich
/// 2013).
class OwnModel : public PoseMethod {
 public:
  using PoseMethod::PoseMethod;
  MethodInfo info() const override {
    return {
        "own_model", "Object's own model + tracker",
        "Pixels measured more than 2 cm before the surface of the object's own model at its "
        "predicted pose are hidden (Wuethrich 2013) and are taken from the region; the estimator "
        "works with the rest, the tracker follows. Needs the object's model."};
  }
  PoseAnswer look(const PoseView& view) override {
    const TrackedPose predicted = at(view.sensed.stamp);
    if (predicted.source == Source::lost)
      return {estimate(view, view.detection.mask.view()), Verdict::visible};
    const Eigen::Isometry3d T_object_camera = predicted.pose.inverse() * cell().T_base_camera;
    const auto rest = without(view.detection.mask, view.detection.box, [&](int u, int v) {
      const std::uint16_t depth = view.sensed.depth(u, v);
      const double expected =
          box_depth(T_object_camera, cell().object_size, cell().camera.intrinsics.ray(u, v));
      return depth != 0 && depth * metres_per_unit < expected - own_tolerance;
    });
    return {estimate(view, rest.view()), Verdict::visible};
  }
};

/// Both cameras' points together give the object's place where the colour image does not (Fetzner
/// 2014).
class TwoCameras : public PoseMethod {
 public:
  using PoseMethod::PoseMethod;
  MethodInfo info() const override {
    return {
        "two_cameras", "Second camera + tracker",
        "The points of both depth cameras at the height of the object's top, near its predicted "
        "place, are fitted by its known outline (after Fetzner 2014). Colour estimates that this "
        "contradicts by more than 2 cm are refused; where there is none, the fit is taken. Needs "
        "a second camera."};
  }
  PoseAnswer look(const PoseView& view) override {
    const auto colour = estimate(view, view.detection.mask.view());
    const TrackedPose predicted = at(view.sensed.stamp);
    if (predicted.source == Source::lost) return {colour, Verdict::visible};
    const auto fitted = fit_object(cell(), view.sensed, predicted.pose);
    constexpr double most_apart = 0.02;  // metres
    const bool agree =
        colour && fitted &&
        (colour->pose.translation() - fitted->pose.translation()).norm() <= most_apart;
    if (agree || !fitted) return {colour, Verdict::visible};
    return {fitted, Verdict::visible};
  }
};

/// Ours: what the labels of the image's own stamp say of the region decides whether its estimate is
/// taken.
class PenumbraPose : public PoseMethod {
 public:
  PenumbraPose(const Cell& cell, const Perception& perception, const PoseTrackerConfig& tracker)
      : PoseMethod(cell, perception, tracker), judge_(cell.camera, cell.rule, cell.links) {}
  MethodInfo info() const override {
    return {
        "penumbra", "Penumbra",
        "Labels of the image's own stamp, verdict over the detected region (5 %); estimates are "
        "taken only while the object is visible, and its pose is predicted meanwhile."};
  }
  PoseAnswer look(const PoseView& view) override {
    const Verdict verdict = judge(view);
    return {estimate(view, view.detection.mask.view()), verdict};
  }

 protected:
  Verdict judge(const PoseView& view) {
    TargetView target;
    target.name = "object";
    target.region = PixelMask{view.detection.mask.view()};
    target.extent = view.detection.extent;
    target.motion = motion_since_good(view.sensed.stamp);
    judge_.begin(view.sensed.robot);
    const Verdict verdict = judge_.judge(target).verdict;
    if (verdict == Verdict::visible) last_good_ = view.sensed.stamp;
    return verdict;
  }

 private:
  /// How far the object's origin has moved in the image since it was last seen well.
  std::optional<Eigen::Vector2d> motion_since_good(std::int64_t stamp) const {
    if (!last_good_) return std::nullopt;
    const TrackedPose before = at(*last_good_), now = at(stamp);
    if (before.source == Source::lost || now.source == Source::lost) return std::nullopt;
    const auto pixel = [&](const TrackedPose& pose) {
      return cell().camera.intrinsics.project(cell().T_base_camera.inverse() *
                                              pose.pose.translation());
    };
    return pixel(now) - pixel(before);
  }

  TargetJudge judge_;
  std::optional<std::int64_t> last_good_;
};

/// Ours, for an estimator that works with part of the object: its tracker takes partly visible
/// ones.
class PenumbraPartial : public PenumbraPose {
 public:
  using PenumbraPose::PenumbraPose;
  MethodInfo info() const override {
    return {
        "penumbra_partial", "Penumbra, partial",
        "As Penumbra, but estimates are taken until 90 % is hidden (the tracker's worst verdict: "
        "partial); pixels that are not labelled clear or front are taken from the region."};
  }
  PoseAnswer look(const PoseView& view) override {
    const Verdict verdict = judge(view);
    const auto& labels = view.sensed.robot.labels.labels;
    const auto rest = without(view.detection.mask, view.detection.box, [&](int u, int v) {
      const Label label{labels(u, v)};
      return label != Label::clear && label != Label::front;
    });
    return {estimate(view, rest.view()), verdict};
  }
};

}  // namespace

PoseTrackerConfig conveyor_tracker(const Cell& cell) {
  PoseTrackerConfig config;
  config.motion = Motion::along_direction;
  config.direction = cell.conveyor_direction;
  return config;
}

PoseMethod::PoseMethod(const Cell& cell, const Perception& perception,
                       const PoseTrackerConfig& tracker)
    : cell_(&cell), perception_(perception), tracker_(tracker) {}

Outcome PoseMethod::take(const PoseAnswer& answer) {
  return tracker_.update(*answer.estimate, answer.verdict);
}

TrackedPose PoseMethod::at(std::int64_t stamp) const { return tracker_.at(stamp); }

std::optional<PoseEstimate> PoseMethod::estimate(const PoseView& view,
                                                 ImageView<const std::uint8_t> mask) const {
  const auto guess = perception_.estimator->estimate(view.matches, mask, perception_.acceptance);
  if (!guess) return std::nullopt;
  return to_base(cell(), view.sensed.stamp, *guess);
}

std::vector<std::unique_ptr<PoseMethod>> make_pose_methods(const Cell& cell,
                                                           const Perception& perception) {
  const PoseTrackerConfig tracker = conveyor_tracker(cell);
  PoseTrackerConfig takes_partial = tracker;
  takes_partial.worst = Verdict::partial;
  std::vector<std::unique_ptr<PoseMethod>> methods;
  methods.push_back(std::make_unique<RawPose>(cell, perception, tracker));
  methods.push_back(std::make_unique<TrackerAlone>(cell, perception, tracker));
  for (const RegionFilter& filter :
       {height_region_filter, silhouette_region_filter, urdf_region_filter}) {
    methods.push_back(std::make_unique<FilteredPose<RawPose>>(cell, perception, tracker, filter));
    methods.push_back(
        std::make_unique<FilteredPose<PoseMethod>>(cell, perception, tracker, filter));
  }
  methods.push_back(std::make_unique<OwnModel>(cell, perception, tracker));
  methods.push_back(std::make_unique<TwoCameras>(cell, perception, tracker));
  methods.push_back(std::make_unique<PenumbraPartial>(cell, perception, takes_partial));
  methods.push_back(std::make_unique<PenumbraPose>(cell, perception, tracker));
  return methods;
}

}  // namespace penumbra::sim
