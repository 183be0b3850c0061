// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/planning/look_ahead.hpp>

#include <io/files/look_ahead_report.hpp>
#include <io/inputs/run_input.hpp>

namespace penumbra::io {

struct LookAheadOptions {
  InputOptions input;
  std::optional<std::filesystem::path> targets;       ///< in place of the recording's
  std::vector<std::filesystem::path> trajectories{};  ///< none: the plan in a bag's topic
  /// Frame in which the motion begins; null: the first with a pose and a motion.
  std::optional<std::int64_t> from;
};

/// What is looked at ahead of a frame.
struct LookAheadInput {
  Robot robot;
  std::size_t frame = 0;                  ///< in which the motions begin
  RobotPose pose;                         ///< in it
  std::vector<ForecastCamera> cameras{};  ///< one, or those of a recording with several
  std::vector<ForecastTarget> targets{};
  std::vector<NamedTrajectory> trajectories{};
  std::vector<TargetReport> now{};   ///< as the first camera measures them; empty without depth
  Image<Rgb8> color{};               ///< of the first camera, as recorded; empty without
  std::vector<std::string> notes{};  ///< a line each
};

/// Reads a frame's poses, targets and images. Throws InputError that names the file, also if the
/// robot's joint positions are not known in the frame, and for trajectories that Trajectory
/// refuses. One that begins elsewhere than the robot is, and Trajectory::notes(), are notes.
[[nodiscard]] LookAheadInput read_look_ahead_input(const LookAheadOptions& options,
                                                   const LineSink& print);

}  // namespace penumbra::io
