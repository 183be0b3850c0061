// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/base/statistics-inl.hpp>

#include <research/method.hpp>
#include <research/robot_filters.hpp>

namespace penumbra::research {
namespace {

constexpr double keypoint_radius = 5.0;  // pixels around the key point
constexpr std::size_t least_depths = 5;  // that a point needs
constexpr double hand_step = 0.10;       // metres that a hand moves in depth between two estimates
constexpr double hand_speed = 0.25;      // m/s by which this grows while nothing is measured

/// Returns the median depth around the key point, metres, of the pixels that `kept(u, v, depth)`
/// keeps.
template <typename Kept>
std::optional<double> depth_around(const View& view, Kept kept) {
  constexpr int r = static_cast<int>(keypoint_radius);
  const auto& image = view.observed.depth;
  const int cu = static_cast<int>(std::lround(view.keypoint.x()));
  const int cv = static_cast<int>(std::lround(view.keypoint.y()));
  std::vector<double> depths;
  for (int v = std::max(cv - r, 0); v <= std::min(cv + r, image.height - 1); ++v)
    for (int u = std::max(cu - r, 0); u <= std::min(cu + r, image.width - 1); ++u) {
      const double depth = image(u, v) * metres_per_unit;
      const bool inside = (u - cu) * (u - cu) + (v - cv) * (v - cv) <= r * r;
      if (inside && depth > 0 && kept(u, v, depth)) depths.push_back(depth);
    }
  if (depths.size() < least_depths) return std::nullopt;
  return detail::median(depths);
}

/// Returns the point at a depth on the key point's ray, in the base frame.
Eigen::Vector3d point_at(const Cell& cell, const View& view, double depth) {
  return surface_at(cell.camera.intrinsics, cell.T_base_camera, view.keypoint.x(),
                    view.keypoint.y(), depth);
}

/// Returns the wrist's centre where its surface was measured at this depth, metres; nothing without
/// a depth.
Answer wrist_at(const Cell& cell, const View& view, const std::optional<double>& depth) {
  Answer answer;
  if (!depth) return answer;
  answer.estimate.emplace();
  answer.estimate->stamp = view.observed.stamp;
  answer.estimate->pose.translation() = point_at(cell, view, *depth + wrist_radius);
  answer.surface = point_at(cell, view, *depth);
  return answer;
}

/// What is measured well in front of where the hand can be is not the hand (after Wuethrich 2013).
Answer look_by_hand_model(const Cell& cell, const View& view, const Follower& follower) {
  const TrackedPose held = follower.at(view.observed.stamp);
  double nearest = 0;
  if (held.source != Source::lost)
    nearest = (cell.T_base_camera.inverse() * held.pose.translation()).z() - wrist_radius -
              hand_step - hand_speed * held.age;
  return wrist_at(cell, view, depth_around(view, [&](int, int, double z) { return z >= nearest; }));
}

/// Returns depths in the first camera, metres, of the points that the second camera measures within
/// 2 cm of the key point's ray.
std::vector<double> second_depths_on_ray(const Cell& cell, const View& view) {
  constexpr double ray_radius = 0.02;  // metres
  constexpr int step = 2;              // pixels
  const Eigen::Isometry3d T_first_second = cell.T_base_camera.inverse() * cell.T_base_second_camera;
  const Eigen::Vector3d along =
      cell.camera.intrinsics.ray(view.keypoint.x(), view.keypoint.y()).normalized();
  const auto& image = view.observed.second_depth;
  std::vector<double> depths;
  for (int v = 0; v < image.height; v += step)
    for (int u = 0; u < image.width; u += step) {
      if (image(u, v) == 0) continue;
      const Eigen::Vector3d p =
          surface_at(cell.camera.intrinsics, T_first_second, u, v, image(u, v) * metres_per_unit);
      const double distance = (p - along * along.dot(p)).squaredNorm();
      if (distance < ray_radius * ray_radius && p.z() > 0) depths.push_back(p.z());
    }
  return depths;
}

/// Returns the surface near the held position that the first camera sees or, if there is none, the
/// second camera from behind (after Fetzner 2014).
Answer look_by_second_camera(const Cell& cell, const View& view, const Follower& follower) {
  const TrackedPose held = follower.at(view.observed.stamp);
  const bool known = held.source != Source::lost;
  const double expected = (cell.T_base_camera.inverse() * held.pose.translation()).z();
  const double most_apart = hand_step + hand_speed * held.age;
  const auto depth = depth_around(view, [&](int, int, double z) {
    return !known || std::abs(z + wrist_radius - expected) < most_apart;
  });
  if (depth || !known) return wrist_at(cell, view, depth);
  std::vector<double> behind = second_depths_on_ray(cell, view);
  std::erase_if(behind,
                [&](double z) { return std::abs(z - wrist_radius - expected) > most_apart; });
  if (behind.size() < least_depths) return {};
  const double far_side = detail::median(behind);
  Answer answer = wrist_at(cell, view, far_side - 2 * wrist_radius);
  answer.surface = point_at(cell, view, far_side);
  return answer;
}

/// Returns Penumbra's verdict on the key point's pixels, and the position from trusted depths only.
Answer look_by_labels(const Cell& cell, const View& view, TargetJudge& judge,
                      TargetMemory& memory) {
  TargetView target;
  target.region = PixelEllipse{view.keypoint, Eigen::Vector2d::Constant(keypoint_radius), 0};
  target.point_pixel = view.keypoint;
  judge.begin(view.observed.robot);
  const Judgement judged = judge.judge(target, memory);
  Answer answer;
  if (judged.point) answer = wrist_at(cell, view, judged.point->z());
  answer.verdict = judged.verdict;
  return answer;
}

}  // namespace

std::vector<Method> make_point_methods(const Cell& cell) {
  PointTrackerConfig tracker;
  tracker.motion = PointMotion::hold;
  PointTrackerConfig takes_partial = tracker;
  takes_partial.worst = Verdict::partial;

  const auto all = [&cell](const View& view, const Follower&) {
    return wrist_at(cell, view, depth_around(view, [](int, int, double) { return true; }));
  };
  std::vector<Method> methods;
  methods.push_back({"raw", "No handling", make_last_estimate(), all});
  methods.push_back({"tracker", "Tracker alone", make_follower(tracker), all});
  for (const RobotFilter& filter : robot_filters) {
    const auto filtered = [&cell, filter](const View& view, const Follower&) {
      return wrist_at(cell, view, depth_around(view, [&](int u, int v, double) {
                        return !filter.removes(cell, view, u, v);
                      }));
    };
    const std::string key = filter.key, name = filter.name;
    methods.push_back({key + "_raw", name, make_last_estimate(), filtered});
    methods.push_back({key, name + " + tracker", make_follower(tracker), filtered});
  }
  methods.push_back({"own_model", "Hand's own model + tracker", make_follower(tracker),
                     std::bind_front(look_by_hand_model, std::cref(cell))});
  methods.push_back({"two_cameras", "Second camera + tracker", make_follower(tracker),
                     std::bind_front(look_by_second_camera, std::cref(cell))});
  for (const bool partial : {true, false}) {
    const auto judge = std::make_shared<TargetJudge>(cell.camera, cell.rule, cell.links);
    const auto memory = std::make_shared<TargetMemory>();
    methods.push_back({partial ? "penumbra_partial" : "penumbra",
                       partial ? "Penumbra, partial" : "Penumbra",
                       make_follower(partial ? takes_partial : tracker),
                       [&cell, judge, memory](const View& view, const Follower&) {
                         return look_by_labels(cell, view, *judge, *memory);
                       }});
  }
  return methods;
}

}  // namespace penumbra::research
