// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

#include <apps/penumbra/arguments.hpp>
#include <io/assembly/camera_mount.hpp>
#include <io/files/frame_source.hpp>
#include <io/files/recording.hpp>
#include <io/files/report_json.hpp>

namespace penumbra::app {

/// What `run` judges, whatever it comes from.
struct RunInput {
  RobotOptions robot_options;
  Robot robot;
  Camera camera;
  std::filesystem::path camera_info;  ///< where faults of the camera are
  PipelineConfig config;              ///< with what the input says: camera's pose, tolerance
  std::optional<io::BeyondMeans> beyond;
  std::optional<std::filesystem::path> targets;  ///< the input's own
  double target_history = 0.0;  ///< PipelineConfig's, for targets that come with the frames
  std::optional<io::UsedBag> bag;

  /// Opens the frames; the robot must outlive them. To be called once.
  std::function<std::unique_ptr<io::FrameSource>(const Robot&)> frames;
};

/// Opens a recording folder or a bag, and tells what of a bag is taken. Throws InputError that
/// names the file.
[[nodiscard]] RunInput open_input(const RunArguments& arguments, std::ostream& told);

/// The two of them.
[[nodiscard]] RunInput open_recording_input(const RunArguments& arguments);
[[nodiscard]] RunInput open_bag_input(const RunArguments& arguments, std::ostream& told);

/// What the options say of where the camera sits. Throws InputError of the pose's file.
[[nodiscard]] io::MountOptions mount_options(const BagArguments& bag);

/// The command line's choice before the recording's before the default.
[[nodiscard]] LabelRule rule_of(const RunArguments& arguments, const LabelRule& recorded);

/// Detectors may be so late, seconds, whose targets come by topics.
inline constexpr double topic_target_history = 0.5;

/// The command line's choices of what is drawn, on top of the input's.
void add_robot_choices(const RunArguments& arguments, RobotOptions& options);

}  // namespace penumbra::app
