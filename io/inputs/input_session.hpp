// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/session/session.hpp>

#include <io/files/settings.hpp>
#include <io/files/sink.hpp>
#include <io/files/targets_file.hpp>
#include <io/inputs/run_input.hpp>

namespace penumbra::io {

/// An input and the settings for judging its frames.
struct SessionOptions {
  InputOptions input;
  Backend backend = Backend::cpu;
  RendererOptions renderer;
  RuleOptions rule;  ///< in place of the recording's
  ImageSpace image = ImageSpace::raw;
  DriftLimits drift = {};                        ///< beyond which a camera's motion is a note
  std::optional<std::filesystem::path> targets;  ///< in place of the recording's
  bool no_targets = false;                       ///< not the recording's either
};

/// The outcome of a run.
struct RunResult {
  Statistics statistics;
  std::vector<std::string> notes;        ///< a line each
  std::size_t frames_without_color = 0;  ///< whose recorded colour could not be shown
  std::string first_without_color;       ///< why not, of the first
  std::string device_fault;              ///< why later frames are not judged; empty: all are
  bool is_stopped = false;               ///< by `go_on`
};

/// An input with its pipeline, judged frame by frame.
class InputSession {
 public:
  /// Opens the input; `print` gets the used topics of a bag. Throws InputError that names the file.
  InputSession(const SessionOptions& options, const LineSink& print)
      : InputSession(options, open_input(options.input, print)) {}
  /// Of an opened input: a camera, or a sensor of points.
  InputSession(const SessionOptions& options, RunInput input);

  [[nodiscard]] const Pipeline& pipeline() const { return session_.pipeline(); }
  [[nodiscard]] bool has_depth() const { return input_.config.has_depth; }
  [[nodiscard]] std::optional<std::size_t> size() const { return source_->size(); }
  [[nodiscard]] ReportHead head() const;  ///< refers to this
  /// See RunInput.
  [[nodiscard]] std::span<const std::filesystem::path> made_files() const {
    return input_.made_files;
  }

  [[nodiscard]] const Drift& drift() const { return session_.drift(); }
  /// Tells a calibration of the camera's pose what the frames are of.
  void set_up(RunningCalibration& calibration) const {
    calibration.follow(input_.robot, *input_.camera, input_.camera->parent, input_.camera->pose());
  }

  /// Judges the frames. Calls `go_on` after each frame and stops if it returns false. Throws
  /// InputError if the first usable frame shows a fault of the input, and what a sink throws.
  [[nodiscard]] RunResult run(const Sinks& sinks, const std::function<bool()>& go_on);

 private:
  void judge_frames(const Sinks& sinks, const std::function<bool()>& go_on, RunResult& result);

  SessionOptions options_;
  RunInput input_;
  std::optional<TargetsFile> targets_;
  Session session_;
  std::unique_ptr<FrameSource> source_;
};

/// Opens a file of targets for an input's frames. Throws InputError.
[[nodiscard]] TargetsFile open_targets(const std::filesystem::path& file, const RunInput& input,
                                       ImageSpace image);

/// Makes a session. Throws InputError that names the camera_info file for a fault of the lens.
[[nodiscard]] Session make_session(Robot robot, const Camera& camera, const PipelineConfig& config,
                                   const DriftLimits& limits,
                                   const std::filesystem::path& camera_info);

/// The same of a sensor of points. Defined in clouds.cpp: a program without clouds replaces it.
[[nodiscard]] Session make_session(Robot robot, const CloudConfig& config);

/// Returns the message of a graphics device's fault, with what the user can do about it.
[[nodiscard]] std::string without_device(const DeviceError& error);

}  // namespace penumbra::io
