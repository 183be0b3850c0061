// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/planning/view_planning.hpp>

#include <io/files/targets_file.hpp>
#include <io/inputs/run_input.hpp>

namespace penumbra::io {

/// What cameras are planned with.
struct PlanningOptions {
  InputOptions input;
  std::optional<std::filesystem::path> targets;  ///< in place of the recording's
  std::filesystem::path candidates;
};

/// The robot's motion in an input.
struct PlanningInput {
  RunInput input;
  TargetsFile targets;  ///< the motion's targets refer to it and to the robot
  std::vector<CameraCandidate> candidates;
  /// The poses and targets of frames in which the robot's pose is known.
  std::vector<Frame> motion;
  std::size_t seen = 0;            ///< frames of the input
  std::vector<std::string> notes;  ///< a line each
};

/// Opens the targets of a file or, without one, of the input at `path`. Throws InputError if there
/// are none.
[[nodiscard]] TargetsFile open_planned_targets(const std::filesystem::path& path,
                                               const std::optional<std::filesystem::path>& given,
                                               const RunInput& input);

/// Reads an input's poses and targets, not its depth. Targets in the camera's frame are placed by
/// the input's camera. Calls `step` after each frame. Throws InputError that names the file, also
/// for targets in pixels and if the robot's pose is known in no frame; other frames' faults are
/// notes.
[[nodiscard]] PlanningInput read_planning_input(const PlanningOptions& options,
                                                const LineSink& print,
                                                const std::function<void()>& step);

}  // namespace penumbra::io
