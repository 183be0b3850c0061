// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace penumbra::research {

/// Settings that all seeds of an experiment share.
struct RunSettings {
  double least_latency = 0.05;   ///< seconds until perception answers, evenly distributed
  double most_latency = 0.30;    ///< seconds
  int perception_every = 3;      ///< perception works on every third frame
  double keypoint_sigma = 3.0;   ///< pixels
  double joint_sigma = 0.0005;   ///< radians: noise of the joints that the methods get
  double joint_latency = 0.004;  ///< seconds by which these joints are older than their stamps
  double belt_jitter = 0.02;     ///< of the belt's speed, relative
  double counted_after = 1.0;    ///< seconds in view before errors count
  double duration = 0;           ///< seconds of each run; 0: the scene's own
};

/// The truth of one frame.
struct FrameTruth {
  double hidden = 0;     ///< fraction of the target's pixels that the robot hides
  bool counted = false;  ///< the target has been in view for RunSettings::counted_after
};

/// Where a method believed the target to be at one frame.
struct Sample {
  bool known = false;                                      ///< the method gave a pose
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the base frame
  double translation_error = 0;                            ///< metres
  double rotation_error = 0;                               ///< radians; conveyor
};

/// The result of one image, once it had arrived.
struct Event {
  bool accepted = false;         ///< an estimate was accepted
  double translation_error = 0;  ///< metres: of the estimate at its own stamp
  bool on_robot = false;         ///< the measured point is on the robot's body; handover
  bool seen = false;             ///< the robot hides nothing of the target
  bool before_robot = false;     ///< the target is seen in front of the robot; handover
};

struct MethodRun {
  std::string key;                   ///< in metrics.json
  std::string name;                  ///< in tables
  std::vector<Sample> samples = {};  ///< one per frame
  std::vector<Event> events = {};    ///< one per image that perception worked on
  std::optional<bool> success = {};  ///< empty if the run ends before its goal
};

/// All methods with one kind of detection.
struct LaneRun {
  std::string key, name;
  std::vector<MethodRun> methods;
};

/// All methods on the frames of one seed.
struct SeedRun {
  std::uint64_t seed = 0;
  double frame_seconds = 0;
  std::vector<FrameTruth> frames;
  std::vector<LaneRun> lanes;
};

/// All runs of one experiment.
struct ExperimentResult {
  std::string experiment;      ///< conveyor or handover
  std::vector<SeedRun> seeds;  ///< at least one
  RunSettings settings;
};

}  // namespace penumbra::research
