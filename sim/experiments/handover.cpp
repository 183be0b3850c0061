// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>

#include <sim/experiments/follower.hpp>
#include <sim/experiments/point_method.hpp>
#include <sim/experiments/robot_watcher.hpp>
#include <sim/experiments/runs.hpp>

namespace penumbra::sim {
namespace {

constexpr double reached_distance = 0.05;  // metres
constexpr double body_distance = 0.03;     // metres from the robot's surface that are on it

constexpr double wrist_radius = 0.036;  // metres from the wrist's surface to its centre

using PointFollower = Follower<PointMethod, PointAnswer>;

/// What the truth says of the wrist in one frame.
struct WristTruth {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // base frame
  double hidden = 0;
  bool seen = false;
  bool before_robot = false;
};

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

class HandoverRun {
 public:
  HandoverRun(std::uint64_t seed, const RunSettings& settings,
              const DetectorMaker<KeypointDetector>& make_detector)
      : settings_(settings),
        simulation_("handover", simulation_options("handover", settings, seed)),
        cell_(cell_of(simulation_)),
        watcher_(simulation_),
        random_(seed) {
    run_.seed = seed;
    run_.frame_seconds = 1.0 / simulation_options("handover", settings, seed).frame_rate;
    cell_.links = watcher_.robot().links().size();
    cell_.rule = watcher_.rule();
    cell_.wrist_radius = wrist_radius;
    const std::uint64_t own_seed = random_();
    if (make_detector)
      keypoints_ = make_detector(cell_, own_seed);
    else
      keypoints_ = std::make_unique<NoisyKeypoints>(cell_, own_seed, settings.keypoint_sigma);
    for (auto& method : make_point_methods(cell_)) followers_.emplace_back(std::move(method));
  }

  SeedRun go(const RunHooks& hooks) {
    SimFrame frame;
    while (simulation_.next(frame)) {
      hooks.see(frame);
      if (run_.frames.empty()) first_stamp_ = frame.stamp;
      const Sensed sensed = watcher_.see(frame);
      const WristTruth truth = truth_of(frame);
      cell_.reach = truth.position.z();
      if (run_.frames.size() % static_cast<std::size_t>(settings_.perception_every) == 0)
        perceive(frame, sensed, truth);
      record(frame.stamp, truth);
      hooks.step();
    }
    if (simulation_.is_whole()) run_.goal = run_.frames.size() - 1;
    run_.lanes.push_back(
        {"keypoint", "Wrist key point of a pose network", {}, std::move(verdicts_)});
    for (PointFollower& follower : followers_) {
      const Sample& last = follower.run().samples.back();
      if (run_.goal)
        follower.run().success = last.known() && last.translation_error < reached_distance;
      run_.methods.push_back(follower.method().info());
      run_.lanes.back().methods.push_back(std::move(follower.run()));
    }
    return std::move(run_);
  }

 private:
  WristTruth truth_of(const SimFrame& frame) const {
    const ObjectTruth& wrist = object_named(frame, "wrist");
    WristTruth truth;
    truth.position = wrist.T_base_object.translation();
    truth.hidden = share(wrist.pixels_behind_robot, wrist.pixels_alone);
    truth.seen = wrist.pixels_alone > 0 && wrist.pixels_behind_robot == 0;
    const Eigen::Vector2d pixel =
        cell_.camera.intrinsics.project(cell_.T_base_camera.inverse() * truth.position);
    const int u = static_cast<int>(pixel.x()), v = static_cast<int>(pixel.y());
    truth.before_robot = truth.seen && u >= 0 && v >= 0 && u < frame.robot_ids.width() &&
                         v < frame.robot_ids.height() && frame.robot_ids(u, v) != 0;
    return truth;
  }

  void perceive(const SimFrame& frame, const Sensed& sensed, const WristTruth& truth) {
    std::uniform_real_distribution<double> latency(settings_.latency.least, settings_.latency.most);
    const auto arrival = frame.stamp + static_cast<std::int64_t>(latency(random_) * 1e9);
    const auto keypoint = keypoints_->detect(frame);
    verdict_.reset();
    if (!keypoint) return;
    for (PointFollower& follower : followers_) {
      const PointAnswer answer = follower.method().look(sensed, *keypoint);
      follower.post(arrival, answer, event_of(answer, frame, truth));
      verdict_ = answer.verdict;  // the last method is ours
    }
  }

  Event event_of(const PointAnswer& answer, const SimFrame& frame, const WristTruth& truth) const {
    Event event;
    event.seen = truth.seen;
    event.before_robot = truth.before_robot;
    event.estimated = answer.estimate.has_value();
    if (!event.estimated) return event;
    const Eigen::Vector3d& position = answer.estimate->position;
    event.translation_error = (position - truth.position).norm();
    event.on_robot = on_robot(answer.surface, frame, truth);
    return event;
  }

  /// Whether a measured surface is the robot's, however near the wrist may be: it lies nearer to
  /// the robot's true surface than to the wrist's.
  bool on_robot(const Eigen::Vector3d& surface, const SimFrame& frame,
                const WristTruth& truth) const {
    const double to_wrist = std::abs((surface - truth.position).norm() - wrist_radius);
    const auto to_robot = watcher_.distance_to_robot(frame.true_joints, surface, body_distance);
    return to_robot && *to_robot < to_wrist;
  }

  void record(std::int64_t stamp, const WristTruth& wrist) {
    FrameTruth truth;
    truth.time = static_cast<double>(stamp - first_stamp_) * 1e-9;
    truth.hidden = wrist.hidden;
    truth.before_robot = wrist.before_robot;
    if (wrist.seen && !in_view_since_) in_view_since_ = truth.time;
    truth.counted = in_view_since_ && truth.time >= *in_view_since_ + settings_.counted_after;
    run_.frames.push_back(truth);
    verdicts_.push_back(verdict_);
    for (PointFollower& follower : followers_) {
      follower.deliver(stamp);
      const TrackedPoint tracked = follower.method().at(stamp);
      Sample sample;
      sample.source = tracked.source;
      sample.pose.translation() = tracked.position;
      sample.translation_error = (tracked.position - wrist.position).norm();
      follower.run().samples.push_back(sample);
    }
  }

  RunSettings settings_;
  Simulation simulation_;
  Cell cell_;
  RobotWatcher watcher_;
  std::mt19937_64 random_;
  std::unique_ptr<KeypointDetector> keypoints_;
  std::vector<PointFollower> followers_;
  std::optional<Verdict> verdict_;
  std::vector<std::optional<Verdict>> verdicts_;
  SeedRun run_;
  std::int64_t first_stamp_ = 0;
  std::optional<double> in_view_since_;
};

}  // namespace

SeedRun run_handover(std::uint64_t seed, const RunSettings& settings, const RunHooks& hooks) {
  return HandoverRun(seed, settings, hooks.keypoint_detector).go(hooks);
}

}  // namespace penumbra::sim
