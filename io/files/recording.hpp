// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

#include <io/files/frame_pattern.hpp>
#include <io/files/pose_file.hpp>
#include <io/files/settings.hpp>

namespace penumbra::io {

/// The meaning of the label "beyond" for verdicts.
enum class BeyondMeans { occluded, visible };

/// A robot of a recording.
struct RecordedRobot {
  std::string name;  ///< empty if it is the only one
  std::filesystem::path urdf;
  RobotOptions options;
  Eigen::Isometry3d T_world_root = Eigen::Isometry3d::Identity();
};

/// Loads the robot, or joins the robots (Robot::join). Throws InputError.
[[nodiscard]] Robot load_robot(const std::vector<RecordedRobot>& robots);

/// Return what is of one of several robots: parts of links ROBOT/LINK as of LINK, and ROBOT/PATTERN
/// as PATTERN. Of the only robot, which has no name, that is all.
[[nodiscard]] std::vector<std::string> patterns_of(const std::vector<std::string>& patterns,
                                                   const std::string& robot);
/// Throws InputError for a joint that names none of several robots.
void check_robots_of(const std::map<std::string, double>& joints,
                     std::span<const std::string> robots);
/// Returns the joints of one robot of several, likewise.
[[nodiscard]] std::map<std::string, double> joints_of(const std::map<std::string, double>& joints,
                                                      const std::string& robot);
[[nodiscard]] std::vector<ExtraMesh> extra_of(const std::vector<ExtraMesh>& extra,
                                              const std::string& robot);

/// The camera of a recording. Optional values are those that the file gives.
struct RecordingCamera {
  std::filesystem::path info;  ///< the camera_info file
  /// `range` holds camera.range where that is written; only `calibrate` does without its pose.
  Camera camera;
  bool rectified = false;
  std::filesystem::path pose = {};       ///< its file
  std::optional<DepthRange> range = {};  ///< metres
  RuleOptions rule = {};
  std::optional<BeyondMeans> beyond = {};
  std::optional<double> depth_scale = {};  ///< metres per unit of the depth images
  bool depth_along_ray = false;            ///< depth is the distance along each pixel's ray
  std::optional<Camera> depth = {};        ///< a depth camera of its own, which has these images
  Eigen::Isometry3d T_camera_depth = Eigen::Isometry3d::Identity();
};

/// The files of the frames.
struct RecordingFrames {
  std::filesystem::path joints;
  std::optional<FramePattern> depth;  ///< null: the camera measures no depth
  std::optional<FramePattern> color;
};

/// A body that is attached in some frames.
struct RecordedBody {
  AttachedBody body;
  std::int64_t first, end;  ///< frames first <= index < end
};

/// A recording folder's description (DESIGN section 4), read and checked. Paths are ready to use.
struct Recording {
  std::filesystem::path file;  ///< the recording.yaml
  std::vector<RecordedRobot> robots;
  RecordingCamera camera;
  RecordingFrames frames;
  std::optional<std::filesystem::path> targets = {};  ///< the targets.yaml
  std::vector<RecordedBody> attached = {};

  /// Reads a recording.yaml, or the one in a folder, with camera_info and camera pose. `camera`:
  /// which one, if the recording has several. Throws InputError that names file, line and key for
  /// unknown, doubled or missing keys, wrong types or values, a pose that is not rigid, and for
  /// what is not supported yet.
  [[nodiscard]] static Recording open(const std::filesystem::path& folder_or_yaml,
                                      const std::string& camera = {});

  /// Returns the names of the recording's cameras; empty for one without `cameras`. Throws
  /// InputError for a name that is no folder's name.
  [[nodiscard]] static std::vector<std::string> cameras(
      const std::filesystem::path& folder_or_yaml);

  [[nodiscard]] Robot load_robot() const { return io::load_robot(robots); }
  /// Returns the options of the robot, or of all robots, with their names before those of links.
  [[nodiscard]] RobotOptions robot_options() const;

  /// Returns a pipeline's defaults with the recording's camera pose and label rule. Throws
  /// InputError if it has no camera pose.
  [[nodiscard]] PipelineConfig pipeline_config() const;
};

/// A recording of point clouds: a recording.yaml with `sensor` in place of `camera`, and
/// `frames.cloud`.
struct CloudRecording {
  std::filesystem::path file;  ///< the recording.yaml
  std::vector<RecordedRobot> robots;
  std::string parent;          ///< link that carries the sensor; empty: the root
  std::filesystem::path pose;  ///< of the points' frame in that link; empty: the identity
  Eigen::Isometry3d T_parent_sensor = Eigen::Isometry3d::Identity();
  CloudRule rule;
  bool has_rays = true;  ///< false: `merged: true`, see Scan::origin
  std::filesystem::path joints;
  FramePattern clouds;
  std::optional<std::filesystem::path> targets;  ///< the targets.yaml
  std::vector<RecordedBody> attached;

  /// As Recording::open. Returns nothing for a recording without `frames.cloud`.
  [[nodiscard]] static std::optional<CloudRecording> open(
      const std::filesystem::path& folder_or_yaml);
};

}  // namespace penumbra::io
