// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <research/run.hpp>

namespace penumbra::research {
namespace {

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

double distance_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

}  // namespace

sim::SimulationOptions simulation_options(const std::string& scene, const RunSettings& settings,
                                          std::uint64_t seed) {
  sim::SimulationOptions options;
  options.seed = seed;
  options.joint_sigma = settings.joint_sigma;
  options.joint_latency = settings.joint_latency;
  options.belt_jitter = scene == "conveyor" ? settings.belt_jitter : 0.0;
  options.second_camera = true;
  options.duration = settings.duration;
  return options;
}

Run::Run(const std::string& scene, std::string target, std::uint64_t seed,
         const RunSettings& settings)
    : settings_(settings),
      simulation_(scene, simulation_options(scene, settings, seed)),
      pipeline_(Robot::load(simulation_.urdf()), simulation_.camera()),
      cell_{.camera = simulation_.camera(),
            .T_base_camera = simulation_.T_base_camera(),
            .T_base_second_camera = simulation_.T_base_second_camera(),
            .rule = pipeline_.rule(),
            .links = pipeline_.robot().links().size(),
            .object_size = simulation_.object_size(),
            .conveyor_direction = simulation_.conveyor_direction()},
      target_(std::move(target)),
      random_(seed) {
  run_.seed = seed;
  run_.frame_seconds = 1.0 / simulation_options(scene, settings, seed).frame_rate;
}

SeedRun Run::go(const std::function<void(const sim::SimFrame&)>& done) {
  sim::SimFrame frame;
  while (simulation_.next(frame)) {
    if (run_.frames.empty()) {
      first_stamp_ = frame.stamp;
      lanes_ = make_lanes(frame, random_());
      for (Lane& lane : lanes_)
        for (const Method& method : lane.methods)
          lane.run.methods.push_back({.key = method.key, .name = method.name});
    }
    const Observation observed = observe(frame);
    const TargetTruth truth = truth_of(frame);
    if (run_.frames.size() % static_cast<std::size_t>(settings_.perception_every) == 0)
      ask_methods(frame, observed, truth);
    record(frame.stamp, truth);
    done(frame);
  }
  if (!simulation_.grasp_stamp() && simulation_.is_whole()) goal_ = run_.frames.size() - 1;
  for (Lane& lane : lanes_) {
    for (MethodRun& method : lane.run.methods)
      if (goal_) method.success = succeeds(method.samples.at(*goal_));
    run_.lanes.push_back(std::move(lane.run));
  }
  return std::move(run_);
}

/// Returns what may be known of the frame; valid until the next call, and while the frame lives.
Observation Run::observe(const sim::SimFrame& frame) {
  const FrameReport& report = pipeline_.process(
      {.stamp = frame.stamp, .depth = frame.depth.view(), .pose = {.positions = frame.joints}});
  Observation observed;
  observed.stamp = frame.stamp;
  observed.depth = frame.depth.view();
  observed.second_depth = frame.second_depth.view();
  observed.robot.labels.labels = report.labels;
  observed.robot.labels.touched = report.virtual_depth.touched;
  observed.robot.virtual_depth = report.virtual_depth;
  observed.robot.measured = frame.depth.view();
  return observed;
}

TargetTruth Run::truth_of(const sim::SimFrame& frame) const {
  const sim::ObjectTruth& object = object_named(frame, target_);
  TargetTruth truth;
  truth.pose = object.T_base_object;
  if (object.pixels_alone == 0) return truth;
  truth.hidden =
      static_cast<double>(object.pixels_behind_robot) / static_cast<double>(object.pixels_alone);
  truth.seen = object.pixels_behind_robot == 0;
  const Eigen::Vector2d pixel =
      cell_.camera.intrinsics.project(cell_.T_base_camera.inverse() * truth.pose.translation());
  const int u = static_cast<int>(pixel.x()), v = static_cast<int>(pixel.y());
  truth.before_robot = truth.seen && u >= 0 && v >= 0 && u < frame.robot_ids.width() &&
                       v < frame.robot_ids.height() && frame.robot_ids(u, v) != 0;
  return truth;
}

void Run::ask_methods(const sim::SimFrame& frame, const Observation& observed,
                      const TargetTruth& truth) {
  std::uniform_real_distribution<double> latency(settings_.least_latency, settings_.most_latency);
  const auto arrival = frame.stamp + static_cast<std::int64_t>(latency(random_) * 1e9);
  const auto views = perceive(frame, observed);
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (!views[i]) continue;
    for (Method& method : lanes_[i].methods) {
      const Answer answer = method.look(*views[i], *method.follower);
      method.follower->post(arrival, answer, event_of(answer, frame, truth));
    }
  }
}

Event Run::event_of(const Answer& answer, const sim::SimFrame& frame,
                    const TargetTruth& truth) const {
  Event event;
  event.seen = truth.seen;
  event.before_robot = truth.before_robot;
  if (!answer.estimate) return event;
  event.translation_error = distance_between(answer.estimate->pose, truth.pose);
  event.on_robot = is_on_robot(answer.surface, frame, truth);
  return event;
}

void Run::record(std::int64_t stamp, const TargetTruth& truth) {
  const double time = static_cast<double>(stamp - first_stamp_) * 1e-9;
  if (truth.seen && !in_view_since_) in_view_since_ = time;
  const auto grasp = simulation_.grasp_stamp();
  if (grasp && stamp <= *grasp) goal_ = run_.frames.size();
  run_.frames.push_back(
      {.hidden = truth.hidden,
       .counted = in_view_since_ && time >= *in_view_since_ + settings_.counted_after});
  for (Lane& lane : lanes_)
    for (std::size_t i = 0; i < lane.methods.size(); ++i) {
      Follower& follower = *lane.methods[i].follower;
      MethodRun& run = lane.run.methods[i];
      follower.deliver(stamp, run.events);
      const TrackedPose tracked = follower.at(stamp);
      run.samples.push_back({.known = tracked.source != Source::lost,
                             .pose = tracked.pose,
                             .translation_error = distance_between(tracked.pose, truth.pose),
                             .rotation_error = angle_between(tracked.pose, truth.pose)});
    }
}

}  // namespace penumbra::research
