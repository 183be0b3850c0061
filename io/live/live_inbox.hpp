// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/fusion/target_fusion.hpp>
#include <penumbra/pipeline/without_robot.hpp>
#include <penumbra/poses/robot_pose.hpp>

#include <io/assembly/frame_assembler.hpp>
#include <io/files/report_json.hpp>
#include <io/live/latency_histogram.hpp>

namespace penumbra::io {

/// Topic names are those on the graph, after remapping and with namespaces.
struct LiveOptions {
  RobotInputOptions robot = {};
  PoseSource poses = PoseSource::joints;
  /// Of each of RobotInputOptions::names.
  std::vector<std::string> description_topics = {"/robot_description"};
  /// Of the only robot; of several robots, one for each.
  std::vector<std::string> joint_topics = {"/joint_states"};
  std::string transform_topic = "/tf";
  std::string static_transform_topic = "/tf_static";
  /// MoveIt's: of all robots, then, of several robots, one for each.
  std::vector<std::string> planning_scene_topics = {"/monitored_planning_scene"};
  std::vector<std::string> attached_topics = {"/attached_collision_object"};  ///< likewise
  std::string plan_topic = "/display_planned_path";                           ///< MoveIt's
  std::vector<std::string> motion_topics = {};  ///< of trajectory_msgs/JointTrajectory
  std::vector<std::string> target_topics = {};
  std::vector<CameraInputOptions> cameras = {};
  std::vector<CloudInputOptions> clouds = {};
  DriftLimits drift = {};  ///< beyond which a camera's motion is a warning
  PointsRule points = {};  ///< which points of an image are published
  double points_rate = 0;  ///< point clouds a second of a camera, at most; 0: one for each image
};

/// Sets names and topics of several robots. `resolve`: from NS/TOPIC to the name on the graph.
void set_robots(LiveOptions& options, const std::vector<std::string>& namespaces,
                const std::function<std::string(const std::string&)>& resolve);

/// The outcome of judging a frame.
struct LiveOutcome {
  bool is_published = false;
  std::string fault;  ///< why it could not be judged; empty if it is published
  FrameStatus status = FrameStatus::ok;
  std::string message;               ///< one line; empty for the status ok
  std::size_t unjudged_targets = 0;  ///< targets of an image that could not be judged
  StageTimes timing;
  PixelCounts pixels;
  std::size_t parts = 0;  ///< FrameReport's
  std::string time_note;  ///< CloudPoints'
  Drift drift;
  std::int64_t stamp = 0;
  std::int64_t arrived = 0;
  std::optional<RendererInfo> renderer;  ///< the renderer used; nothing if it could not be made
  CameraFrame views;                     ///< of the targets, if the frame is published
  /// Finds the warnings about a camera's setup. Takes a second, on any thread; mostly null.
  std::function<std::vector<std::string>()> find_warnings;
};

/// The results of a sensor's frames.
struct LiveTally {
  static constexpr std::int64_t recent_time = 10'000'000'000;  ///< nanoseconds

  std::map<std::string, std::size_t, std::less<>> statuses;  ///< frames by status
  LatencyHistogram latency;      ///< from stamp to published, ms of the system's clock
  LatencyHistogram processing;   ///< from arrival to published, ms
  std::size_t beyond_clock = 0;  ///< images with stamps of another clock; no latency
  LiveOutcome last;
  /// When the frames of the last `recent_time` were published, and whether they were ok.
  std::deque<std::pair<std::int64_t, bool>> recent;
  std::string last_trouble;           ///< status and message of the last frame that was not ok
  std::vector<std::string> warnings;  ///< about the setup `warned`, a line each
  std::weak_ptr<const SensorSetup> warned;
  PixelCounts points;                          ///< of all clouds
  std::size_t parts = 0;                       ///< the most of a scan
  std::string time_note;                       ///< the first one
  std::optional<RendererInfo> renderer;        ///< the last one; nothing if no image was judged yet
  std::optional<std::int64_t> last_published;  ///< on the caller's clock
};

/// An assembler of a graph's topics that tallies the outcome of its frames.
class LiveInbox : public FrameAssembler {
 public:
  /// Throws InputError like FrameAssembler.
  explicit LiveInbox(const LiveOptions& options);

  /// Counts the outcome of a frame, once. `system_now`: nanoseconds since 1970.
  void done(std::size_t sensor, const LiveOutcome& outcome, std::int64_t now,
            std::int64_t system_now);

  /// Sets the warnings about a sensor's setup.
  void warn(std::size_t sensor, const std::shared_ptr<const SensorSetup>& setup,
            std::vector<std::string> warnings);

  /// Returns the warnings about a sensor's present setup, and whether a camera has moved.
  [[nodiscard]] std::vector<std::string> warnings(std::size_t sensor) const;

  [[nodiscard]] const LiveOptions& options() const { return options_; }
  [[nodiscard]] const LiveTally& tally(std::size_t sensor) const { return tallies_[sensor]; }

 private:
  void add_topics_of_robot();
  void add_topics_of_camera(std::size_t camera);

  LiveOptions options_;
  std::vector<LiveTally> tallies_;
};

}  // namespace penumbra::io
