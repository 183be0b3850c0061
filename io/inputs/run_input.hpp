// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/assembly/bag_options.hpp>
#include <io/files/frame_source.hpp>
#include <io/files/recording.hpp>
#include <io/files/report_json.hpp>

namespace penumbra::io {

struct CloudInputOptions;

/// Frames first <= index < end; bounds are optional.
struct FrameRange {
  std::optional<std::int64_t> first, end;
  std::string option = "--frames";  ///< that gave it, for messages
};

/// A recording folder or a bag, and how it is read.
struct InputOptions {
  std::filesystem::path path;
  std::string camera;  ///< which one, of a recording with several
  /// Read colour images; of a camera without depth some are, for Session's diagnosis.
  bool with_color = false;
  std::optional<Geometry> geometry;   ///< in place of the recording's
  bool geometry_fallback = false;     ///< of RobotOptions, in addition to the recording's
  bool allow_missing_meshes = false;  ///< likewise
  std::vector<ExtraMesh> extra;       ///< likewise
  /// Likewise; of several robots, ROBOT/PATTERN.
  std::vector<std::string> ignore_links;
  std::map<std::string, double> joints = {};  ///< likewise, ROBOT/JOINT
  bool needs_camera_pose = true;  ///< false: it may be unknown, and is then the identity
  bool needs_depth = false;       ///< true: a recording without depth images is an error
  FrameRange frames;
  std::optional<double> fps;  ///< of a recording without stamps, 1/s
  int threads = 0;            ///< that decode images; 0: one per core; 1: none of their own
  BagOptions bag;
  std::string bag_option;  ///< name of a bag's option that was given; empty: none

  /// Adds these settings to the input's own, of the robot of that name; empty: the only robot.
  void apply_to(RobotOptions& robot, const std::string& name = {}) const;
};

/// An opened input: a camera's images, or a sensor's clouds.
struct RunInput {
  RobotOptions robot_options;
  Robot robot;
  std::optional<Camera> camera = {};  ///< null: a sensor of points
  std::filesystem::path camera_info;  ///< named in errors of the camera
  PipelineConfig config;  ///< with what the input gives: camera's pose if not by tf, tolerance
  std::optional<BeyondMeans> beyond;
  std::optional<std::filesystem::path> targets;  ///< the input's own
  std::vector<std::int64_t> frame_numbers = {};  ///< all, ascending; empty: not known
  std::optional<FrameStamps> stamps = {};        ///< of a recording whose images are named by time
  double target_history = 0.0;  ///< PipelineConfig's, for targets that come with the frames
  std::optional<UsedBag> bag;
  /// Those of its files that tune and calibrate make, too: the camera's pose, parts.
  std::vector<std::filesystem::path> made_files;

  /// Opens the frames from the first one.
  std::function<std::unique_ptr<FrameSource>()> frames;

  // Of a sensor of points:
  CloudConfig cloud = {};
  UsedClouds used_clouds = {};                   ///< with the rule of `cloud`
  std::string sensor = {};                       ///< its topic, or the folder of its files
  std::optional<FramePattern> cloud_files = {};  ///< of a recording
};

/// Says why an input without depth is refused where InputOptions::needs_depth is set.
inline constexpr const char* needs_depth_images =
    "this compares depth images with the robot; only `penumbra calibrate` does without, by "
    "--images "
    "or --masks";

/// Returns whether an input is a bag, by its name or, of a folder, its files.
[[nodiscard]] bool is_bag(const std::filesystem::path& input);
/// Throws InputError for an input that is neither a bag nor a recording.
void check_is_recording(const std::filesystem::path& input);

/// Throws InputError if an option of bags was given with a recording.
void check_no_bag_option(const InputOptions& options);

/// Returns the names of a recording's cameras; empty for a bag, or a recording with one camera.
/// Throws InputError that names the file.
[[nodiscard]] std::vector<std::string> cameras_of(const std::filesystem::path& input);

/// Takes a line of text.
using LineSink = std::function<void(const std::string&)>;

/// Opens a recording folder or a bag; `print` gets the used topics of a bag. Throws InputError that
/// names the file.
[[nodiscard]] RunInput open_input(const InputOptions& options, const LineSink& print);

/// The same for a bag.
[[nodiscard]] RunInput open_bag_input(const InputOptions& options, const LineSink& print);

/// The same for each of a bag's topics of clouds. `clouds`: what is the same of all.
[[nodiscard]] std::vector<RunInput> open_bag_clouds(const InputOptions& options,
                                                    const CloudInputOptions& clouds,
                                                    const LineSink& print);

}  // namespace penumbra::io
