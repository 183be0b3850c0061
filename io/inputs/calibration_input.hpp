// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/calibration/calibration.hpp>

#include <io/inputs/run_input.hpp>

namespace penumbra::io {

/// What is calibrated with.
struct CalibrationInputOptions {
  InputOptions input;
  /// Name pattern of images that are not 0 where the robot is, and KeptFrame::not_known where that
  /// is not known, next to the recording.yaml or bag. Frames without one are left out.
  std::optional<std::string> masks;
  /// Take the input's colour images in place of depth. Frames without one are left out.
  bool images = false;
  bool time_offset = false;  ///< choose moving frames, and give them the poses around them
};

/// The chosen frames of an input.
struct CalibrationInput {
  RunInput input;     ///< its config has the camera's pose, also if it was by tf
  Intrinsics camera;  ///< of the frames' images, which are free of distortion
  std::vector<KeptFrame> frames;
  std::optional<Eigen::Isometry3d> T_by_tf = {};  ///< the camera's pose in its link; null: none
  std::size_t seen = 0;                           ///< frames of the input
  std::vector<std::string> notes;                 ///< a line each
};

/// Reads an input and keeps frames between which the robot moves, those in which it stands still
/// before the others, or only moving ones for the time offset. Calls `step` after each frame.
/// Throws InputError that names the file; a frame's own faults are notes.
[[nodiscard]] CalibrationInput read_calibration_input(const CalibrationInputOptions& options,
                                                      const LineSink& print,
                                                      const std::function<void()>& step);

}  // namespace penumbra::io
