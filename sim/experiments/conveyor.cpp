// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include <sim/experiments/follower.hpp>
#include <sim/experiments/pose_method.hpp>
#include <sim/experiments/robot_watcher.hpp>
#include <sim/experiments/runs.hpp>

namespace penumbra::sim {
namespace {

constexpr double grasp_distance = 0.01;             // metres
constexpr double grasp_angle = 5.0 * M_PI / 180.0;  // radians

using PoseFollower = Follower<PoseMethod, PoseAnswer>;

/// All methods with one kind of perception.
struct PoseLane {
  std::string key, name;
  std::unique_ptr<Detector> detector;
  std::vector<PoseFollower> followers;
  std::optional<Verdict> verdict = {};
  std::vector<std::optional<Verdict>> verdicts = {};
};

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

void add_followers(PoseLane& lane, const Cell& cell, const Perception& perception) {
  for (auto& method : make_pose_methods(cell, perception))
    lane.followers.emplace_back(std::move(method));
}

double hidden_share(const ObjectTruth& object) {
  return object.pixels_alone == 0 ? 0.0
                                  : static_cast<double>(object.pixels_behind_robot) /
                                        static_cast<double>(object.pixels_alone);
}

PixelBox box_about(const PixelBox& a, const PixelBox& b) {
  const double u = std::min(a.u, b.u), v = std::min(a.v, b.v);
  return {u, v, std::max(a.u + a.width, b.u + b.width) - u,
          std::max(a.v + a.height, b.v + b.height) - v};
}

/// One run: what is watched, and by whom.
class ConveyorRun {
 public:
  ConveyorRun(std::uint64_t seed, const RunSettings& settings)
      : settings_(settings),
        simulation_("conveyor", options(seed)),
        cell_(cell_of(simulation_)),
        watcher_(simulation_),
        estimator_(cell_.camera, simulation_.model_image().view(), cell_.object_size),
        random_(seed) {
    run_.seed = seed;
    run_.frame_seconds = 1.0 / options(seed).frame_rate;
    cell_.links = watcher_.robot().links().size();
    cell_.rule = watcher_.rule();
  }

  SeedRun go(const RunHooks& hooks) {
    SimFrame frame;
    while (simulation_.next(frame)) {
      hooks.see(frame);
      if (run_.frames.empty()) begin(frame, hooks.detector);
      const ObjectTruth& object = object_named(frame, "parcel");
      const Sensed sensed = watcher_.see(frame);
      if (run_.frames.size() % static_cast<std::size_t>(settings_.perception_every) == 0)
        perceive(frame, sensed, object);
      record(frame.stamp, object);
      hooks.step();
    }
    for (PoseFollower& follower : lanes_.front().followers)
      run_.methods.push_back(follower.method().info());
    for (PoseLane& lane : lanes_) {
      run_.lanes.push_back({lane.key, lane.name, {}, std::move(lane.verdicts)});
      for (PoseFollower& follower : lane.followers) {
        if (run_.goal) follower.run().success = grasps(follower.run().samples.at(*run_.goal));
        run_.lanes.back().methods.push_back(std::move(follower.run()));
      }
    }
    return std::move(run_);
  }

 private:
  SimulationOptions options(std::uint64_t seed) const {
    return simulation_options("conveyor", settings_, seed);
  }

  static bool grasps(const Sample& sample) {
    return sample.known() && sample.translation_error < grasp_distance &&
           sample.rotation_error < grasp_angle;
  }

  void begin(const SimFrame& frame, const DetectorMaker<Detector>& make_detector) {
    first_stamp_ = frame.stamp;
    const Eigen::Isometry3d& pose = object_named(frame, "parcel").T_base_object;
    cell_.floor = pose.translation().z() - 0.5 * cell_.object_size.z();
    const std::uint64_t seed = random_();
    for (const Acceptance acceptance : {Acceptance::careful, Acceptance::eager}) {
      const bool careful = acceptance == Acceptance::careful;
      const std::string key = careful ? "" : "_eager";
      const std::string estimator = careful ? "careful estimator" : "eager estimator";
      if (make_detector) {
        add_lane("own" + key, "Detector that was given, " + estimator, make_detector(cell_, seed),
                 acceptance);
        continue;
      }
      add_lane("amodal" + key, "Detector of full extents (amodal), " + estimator,
               std::make_unique<AmodalDetector>(cell_, seed), acceptance);
      add_lane("modal" + key, "Detector of visible pixels (modal), " + estimator,
               std::make_unique<ModalDetector>(seed), acceptance);
    }
  }

  void add_lane(const std::string& key, const std::string& name, std::unique_ptr<Detector> detector,
                Acceptance acceptance) {
    lanes_.push_back({key, name, std::move(detector), {}});
    add_followers(lanes_.back(), cell_, {&estimator_, acceptance});
  }

  void perceive(const SimFrame& frame, const Sensed& sensed, const ObjectTruth& object) {
    std::uniform_real_distribution<double> latency(settings_.latency.least, settings_.latency.most);
    const auto arrival = frame.stamp + static_cast<std::int64_t>(latency(random_) * 1e9);
    std::vector<std::optional<Detection>> detections;
    std::optional<PixelBox> part;
    for (PoseLane& lane : lanes_) {
      detections.push_back(lane.detector->detect(frame));
      if (const auto& found = detections.back())
        part = part ? box_about(*part, found->box) : found->box;
    }
    for (PoseLane& lane : lanes_) lane.verdict.reset();
    if (!part) return;
    const auto matches = estimator_.match(frame.color.view(), *part);
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      if (!detections[i]) continue;
      for (PoseFollower& follower : lanes_[i].followers) {
        PoseAnswer answer = follower.method().look({sensed, *detections[i], matches});
        const Event event = event_of(answer, object);
        lanes_[i].verdict = answer.verdict;  // the last method is ours
        follower.post(arrival, std::move(answer), event);
      }
    }
  }

  static Event event_of(const PoseAnswer& answer, const ObjectTruth& object) {
    Event event;
    event.seen = object.pixels_alone > 0 && hidden_share(object) == 0;
    event.estimated = answer.estimate.has_value();
    if (!event.estimated) return event;
    const Eigen::Isometry3d& pose = answer.estimate->pose;
    event.translation_error = (pose.translation() - object.T_base_object.translation()).norm();
    event.rotation_error = angle_between(pose, object.T_base_object);
    return event;
  }

  void record(std::int64_t stamp, const ObjectTruth& object) {
    FrameTruth truth;
    truth.time = static_cast<double>(stamp - first_stamp_) * 1e-9;
    truth.hidden = hidden_share(object);
    if (object.pixels_alone > 0 && truth.hidden == 0 && !in_view_since_)
      in_view_since_ = truth.time;
    truth.counted = in_view_since_ && truth.time >= *in_view_since_ + settings_.counted_after;
    const auto grasp = simulation_.grasp_stamp();
    if (grasp && stamp <= *grasp) run_.goal = run_.frames.size();
    run_.frames.push_back(truth);
    for (PoseLane& lane : lanes_) {
      lane.verdicts.push_back(lane.verdict);
      for (PoseFollower& follower : lane.followers) {
        follower.deliver(stamp);
        const TrackedPose tracked = follower.method().at(stamp);
        Sample sample;
        sample.source = tracked.source;
        sample.pose = tracked.pose;
        sample.translation_error =
            (tracked.pose.translation() - object.T_base_object.translation()).norm();
        sample.rotation_error = angle_between(tracked.pose, object.T_base_object);
        follower.run().samples.push_back(sample);
      }
    }
  }

  RunSettings settings_;
  Simulation simulation_;
  Cell cell_;
  RobotWatcher watcher_;
  PoseEstimator estimator_;
  std::mt19937_64 random_;
  std::vector<PoseLane> lanes_;
  SeedRun run_;
  std::int64_t first_stamp_ = 0;
  std::optional<double> in_view_since_;
};

}  // namespace

SeedRun run_conveyor(std::uint64_t seed, const RunSettings& settings, const RunHooks& hooks) {
  return ConveyorRun(seed, settings).go(hooks);
}

}  // namespace penumbra::sim
