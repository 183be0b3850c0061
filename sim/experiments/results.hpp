// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/occlusion/target.hpp>
#include <penumbra/tracking/track.hpp>

#include <io/png.hpp>
#include <sim/experiments/method_info.hpp>

namespace penumbra::sim {

/// How late perception answers, evenly distributed, seconds.
struct Latency {
  double least = 0.05, most = 0.30;
};

/// What is the same in all seeds of an experiment.
struct RunSettings {
  Latency latency;
  int perception_every = 3;      ///< frames from one that perception works on to the next
  double keypoint_sigma = 3.0;   ///< pixels
  double joint_sigma = 0.0005;   ///< radians: of the joints that the methods get
  double joint_latency = 0.004;  ///< seconds by which they are older than they say
  double belt_jitter = 0.02;     ///< of the belt's speed, relative
  double counted_after = 1.0;    ///< seconds in view before errors count
  double duration = 0;           ///< seconds of each run; 0: the scene's own
};

/// What was true at one frame.
struct FrameTruth {
  double time = 0;            ///< seconds since the first frame
  double hidden = 0;          ///< share of the target's pixels that the robot hides
  bool before_robot = false;  ///< the target is seen, and the robot lies behind it
  bool counted = false;       ///< the target has been in view long enough to be known
};

/// Where a method believed the target to be at one frame.
struct Sample {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the base frame
  Source source = Source::lost;
  double translation_error = 0;  ///< metres
  double rotation_error = 0;     ///< radians; 0 for a point
  [[nodiscard]] bool known() const { return source != Source::lost; }
};

/// What became of one image's estimate, once it had arrived.
struct Event {
  bool estimated = false;  ///< there was an estimate
  bool accepted = false;
  double translation_error = 0;  ///< metres: of the estimate at its own stamp
  double rotation_error = 0;     ///< radians
  bool on_robot = false;         ///< what was measured is the robot's body
  bool seen = false;             ///< the robot hid nothing of the target
  bool before_robot = false;     ///< as in FrameTruth
};

struct MethodRun {
  std::vector<Sample> samples;  ///< one per frame
  std::vector<Event> events;    ///< one per image that perception worked on
  std::optional<bool> success;  ///< nothing where the run has no goal
};

/// The same methods with one kind of detection.
struct LaneRun {
  std::string key, name;
  std::vector<MethodRun> methods;
  std::vector<std::optional<Verdict>> verdicts;  ///< ours, one per frame: of the last image that
                                                 ///< perception worked on; nothing undetected
};

struct SeedRun {
  std::uint64_t seed = 0;
  double frame_seconds = 0;
  std::vector<FrameTruth> frames;
  std::optional<std::size_t> goal;  ///< the frame of the grasp, or in which the hand is reached;
                                    ///< nothing: the run is shorter
  std::vector<MethodInfo> methods;
  std::vector<LaneRun> lanes;
};

/// A key frame for the report.
struct Picture {
  std::size_t frame = 0;
  Image<io::Rgb8> image;
  std::string title;
};

/// All runs of one experiment.
struct ExperimentResult {
  std::string experiment;         ///< conveyor or handover
  std::vector<SeedRun> seeds;     ///< at least one
  std::vector<Picture> pictures;  ///< of the first seed
  RunSettings settings;
};

/// A hidden share above which a frame counts as occluded (the paper).
inline constexpr double occluded_share = 0.05;

}  // namespace penumbra::sim
