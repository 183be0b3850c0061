// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

#include <sim/experiments/point_method.hpp>
#include <sim/experiments/ray_cloud.hpp>
#include <sim/experiments/robot_filters.hpp>

namespace penumbra::sim {
namespace {

constexpr double plane_margin = 0.05;    // metres above the wrist
constexpr double hand_step = 0.10;       // metres that a hand comes nearer between two estimates
constexpr double hand_speed = 0.25;      // m/s by which that grows while nothing is measured
constexpr std::size_t least_depths = 5;  // that a point needs

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The median depth about a key point of those pixels that `kept(u, v, depth)` keeps, metres.
template <typename Kept>
std::optional<double> depth_about(const Sensed& sensed, const Keypoint& keypoint, Kept kept) {
  constexpr int r = static_cast<int>(PointMethod::radius);
  const int cu = static_cast<int>(std::lround(keypoint.pixel.x()));
  const int cv = static_cast<int>(std::lround(keypoint.pixel.y()));
  std::vector<double> depths;
  for (int v = std::max(cv - r, 0); v <= std::min(cv + r, sensed.depth.height - 1); ++v)
    for (int u = std::max(cu - r, 0); u <= std::min(cu + r, sensed.depth.width - 1); ++u) {
      const double depth = sensed.depth(u, v) * 1e-3;
      const bool inside = (u - cu) * (u - cu) + (v - cv) * (v - cv) <= r * r;
      if (inside && depth > 0 && kept(u, v, depth)) depths.push_back(depth);
    }
  if (depths.size() < least_depths) return std::nullopt;
  return median_of(depths);
}

/// The last point as it came.
class RawPoint : public PointMethod {
 public:
  using PointMethod::PointMethod;
  MethodInfo info() const override {
    return {"raw", "No handling",
            "The median depth about the key point, the last that arrived, as it is."};
  }
  PointAnswer look(const Sensed& sensed, const Keypoint& keypoint) override {
    const auto depth = depth_about(sensed, keypoint, [](int, int, double) { return true; });
    if (!depth) return {};
    return wrist_at(sensed, keypoint, *depth);
  }
  Outcome take(const PointAnswer& answer) override {
    if (!last_ || answer.estimate->stamp > last_->stamp) last_ = answer.estimate;
    return Outcome::accepted;
  }
  TrackedPoint at(std::int64_t stamp) const override {
    TrackedPoint point;
    if (!last_) return point;
    point.source = Source::held;
    point.age = static_cast<double>(stamp - last_->stamp) * 1e-9;
    point.position = last_->position;
    return point;
  }

 private:
  std::optional<PointEstimate> last_;
};

/// Every point goes to the tracker, whose gate is all that refuses.
class PointTrackerAlone : public PointMethod {
 public:
  using PointMethod::PointMethod;
  MethodInfo info() const override {
    return {"tracker", "Tracker alone",
            "Every point goes to the same tracker as in all methods below, which holds the last "
            "accepted one; only its outlier gate refuses."};
  }
  PointAnswer look(const Sensed& sensed, const Keypoint& keypoint) override {
    const auto depth = depth_about(sensed, keypoint, [](int, int, double) { return true; });
    if (!depth) return {};
    return wrist_at(sensed, keypoint, *depth);
  }
};

/// A way of taking the robot out of a depth image.
struct DepthFilter {
  const char* key;
  const char* name;
  const char* idea;
  bool (*removes)(const Cell& cell, const Sensed& sensed, int u, int v, double depth);
};

/// Points above a plane are robot (Yoshioka 2021).
constexpr DepthFilter height_depth_filter{
    "height", "Height threshold",
    "Points above a plane are robot and are taken from the depth image (Yoshioka 2021). The plane "
    "is better than any real one: 5 cm above the wrist's true height at every instant.",
    [](const Cell& cell, const Sensed&, int u, int v, double depth) {
      return surface_at(cell.camera.intrinsics, cell.T_base_camera, u, v, depth).z() >
             cell.reach + plane_margin;
    }};

constexpr DepthFilter silhouette_depth_filter{
    "silhouette", "Silhouette subtraction",
    "Every pixel on which the robot's model is drawn is taken from the depth image, also where "
    "something before the robot was measured; with the same renderer and joints as ours.",
    [](const Cell&, const Sensed& sensed, int u, int v, double) {
      return on_silhouette(sensed, u, v);
    }};

constexpr DepthFilter urdf_depth_filter{
    "urdf_filter", "URDF filter",
    "Pixels on which the robot's model is drawn are taken from the depth image where the measured "
    "depth lies beyond the drawn one less 5 cm: realtime_urdf_filter's rule with the threshold "
    "that it ships, with the same renderer and joints as ours.",
    [](const Cell&, const Sensed& sensed, int u, int v, double) {
      return urdf_filtered(sensed, u, v);
    }};

/// The median depth about the key point of what a filter leaves; `Base` says who follows.
template <typename Base>
class FilteredPoint : public Base {
 public:
  FilteredPoint(const Cell& cell, const PointTrackerConfig& tracker, const DepthFilter& filter)
      : Base(cell, tracker), filter_(filter) {}
  MethodInfo info() const override {
    if (std::is_base_of_v<RawPoint, Base>)
      return {filter_.key + std::string("_raw"), filter_.name,
              filter_.idea + std::string(" The last position that arrived, as it is.")};
    return {filter_.key, filter_.name + std::string(" + tracker"),
            "The same, and our tracker follows."};
  }
  PointAnswer look(const Sensed& sensed, const Keypoint& keypoint) override {
    const auto depth = depth_about(sensed, keypoint, [&](int u, int v, double z) {
      return !filter_.removes(this->cell(), sensed, u, v, z);
    });
    if (!depth) return {};
    return this->wrist_at(sensed, keypoint, *depth);
  }

 private:
  DepthFilter filter_;
};

/// What is measured well before where the hand can be is not the hand (after Wuethrich 2013).
class PointOwnModel : public PointMethod {
 public:
  using PointMethod::PointMethod;
  MethodInfo info() const override {
    return {
        "own_model", "Hand's own model + tracker",
        "Depths more than 10 cm (and 25 cm/s of age) nearer than the hand's surface at its held "
        "place are not the hand's (after Wuethrich 2013) and are taken from the depth image."};
  }
  PointAnswer look(const Sensed& sensed, const Keypoint& keypoint) override {
    const TrackedPoint held = at(sensed.stamp);
    double nearest = 0;
    if (held.source != Source::lost)
      nearest = (cell().T_base_camera.inverse() * held.position).z() - cell().wrist_radius -
                hand_step - hand_speed * held.age;
    const auto depth =
        depth_about(sensed, keypoint, [&](int, int, double z) { return z >= nearest; });
    if (!depth) return {};
    return wrist_at(sensed, keypoint, *depth);
  }
};

/// The surface on the key point's ray that is nearest to the held place, seen by the first camera
/// or else by the second, from behind (after Fetzner 2014).
class PointTwoCameras : public PointMethod {
 public:
  using PointMethod::PointMethod;
  MethodInfo info() const override {
    return {
        "two_cameras", "Second camera + tracker",
        "Depths of the first camera near the wrist's held place (10 cm, and 25 cm/s of age); "
        "where there are none, points of the second camera there that lie on the key point's ray "
        "(after Fetzner 2014). Needs a second camera."};
  }
  PointAnswer look(const Sensed& sensed, const Keypoint& keypoint) override {
    const TrackedPoint held = at(sensed.stamp);
    const bool known = held.source != Source::lost;
    const double expected = (cell().T_base_camera.inverse() * held.position).z();
    const double most_apart = hand_step + hand_speed * held.age;
    const auto depth = depth_about(sensed, keypoint, [&](int, int, double z) {
      return !known || std::abs(z + cell().wrist_radius - expected) < most_apart;
    });
    if (depth) return wrist_at(sensed, keypoint, *depth);
    if (!known) return {};
    std::vector<double> behind = second_depths_on_ray(cell(), sensed, keypoint.pixel);
    std::erase_if(behind, [&](double z) {
      return std::abs(z - cell().wrist_radius - expected) > most_apart;
    });
    if (behind.size() < least_depths) return {};
    const double far_side = median_of(behind);
    PointAnswer answer = wrist_at(sensed, keypoint, far_side - 2 * cell().wrist_radius);
    answer.surface = point_at(keypoint, far_side);
    return answer;
  }
};

/// Ours: the verdict on the key point's pixels by the labels of its own stamp.
class PenumbraPoint : public PointMethod {
 public:
  PenumbraPoint(const Cell& cell, const PointTrackerConfig& tracker)
      : PointMethod(cell, tracker), judge_(cell.camera, cell.rule, cell.links) {}
  MethodInfo info() const override {
    return {"penumbra", "Penumbra",
            "Labels of the image's own stamp, verdict over the key point's pixels (5 %), position "
            "from trusted depths only; the last trusted position is held meanwhile."};
  }
  PointAnswer look(const Sensed& sensed, const Keypoint& keypoint) override {
    TargetView target;
    target.name = "wrist";
    target.region = PixelEllipse{keypoint.pixel, Eigen::Vector2d::Constant(radius), 0};
    target.point_pixel = keypoint.pixel;
    judge_.begin(sensed.robot);
    const Judgement judged = judge_.judge(target);
    if (!judged.point) return {std::nullopt, judged.verdict, {}};
    PointAnswer answer = wrist_at(sensed, keypoint, judged.point->z());
    answer.verdict = judged.verdict;
    return answer;
  }

 private:
  TargetJudge judge_;
};

class PenumbraPartialPoint : public PenumbraPoint {
 public:
  using PenumbraPoint::PenumbraPoint;
  MethodInfo info() const override {
    return {"penumbra_partial", "Penumbra, partial",
            "As Penumbra, but positions from the trusted depths of partly visible key points are "
            "taken, too (the tracker's worst verdict: partial)."};
  }
};

}  // namespace

PointTrackerConfig handover_tracker() {
  PointTrackerConfig config;
  config.motion = PointMotion::hold;
  return config;
}

PointMethod::PointMethod(const Cell& cell, const PointTrackerConfig& tracker)
    : cell_(&cell), tracker_(tracker) {}

Outcome PointMethod::take(const PointAnswer& answer) {
  return tracker_.update(*answer.estimate, answer.verdict);
}

TrackedPoint PointMethod::at(std::int64_t stamp) const { return tracker_.at(stamp); }

PointAnswer PointMethod::wrist_at(const Sensed& sensed, const Keypoint& keypoint,
                                  double depth) const {
  PointAnswer answer;
  answer.estimate.emplace();
  answer.estimate->stamp = sensed.stamp;
  answer.estimate->position = point_at(keypoint, depth + cell_->wrist_radius);
  answer.surface = point_at(keypoint, depth);
  return answer;
}

Eigen::Vector3d PointMethod::point_at(const Keypoint& keypoint, double depth) const {
  return surface_at(cell_->camera.intrinsics, cell_->T_base_camera, keypoint.pixel.x(),
                    keypoint.pixel.y(), depth);
}

std::vector<std::unique_ptr<PointMethod>> make_point_methods(const Cell& cell) {
  const PointTrackerConfig tracker = handover_tracker();
  PointTrackerConfig takes_partial = tracker;
  takes_partial.worst = Verdict::partial;
  std::vector<std::unique_ptr<PointMethod>> methods;
  methods.push_back(std::make_unique<RawPoint>(cell, tracker));
  methods.push_back(std::make_unique<PointTrackerAlone>(cell, tracker));
  for (const DepthFilter& filter :
       {height_depth_filter, silhouette_depth_filter, urdf_depth_filter}) {
    methods.push_back(std::make_unique<FilteredPoint<RawPoint>>(cell, tracker, filter));
    methods.push_back(std::make_unique<FilteredPoint<PointMethod>>(cell, tracker, filter));
  }
  methods.push_back(std::make_unique<PointOwnModel>(cell, tracker));
  methods.push_back(std::make_unique<PointTwoCameras>(cell, tracker));
  methods.push_back(std::make_unique<PenumbraPartialPoint>(cell, takes_partial));
  methods.push_back(std::make_unique<PenumbraPoint>(cell, tracker));
  return methods;
}

}  // namespace penumbra::sim
