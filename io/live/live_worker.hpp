// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include <penumbra/session/session.hpp>

#include <io/assembly/depth_input.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/live/frame_watcher.hpp>
#include <io/live/live_inbox.hpp>

namespace penumbra::io {

/// Judges the frames of one sensor. Use one thread at a time, without the lock of the poses.
class LiveWorker {
 public:
  /// `options` must outlive this. `config`: of a camera, whose pose and parent are replaced by
  /// those of each setup. `poses` guards the robot's poses; null: nobody changes them.
  /// `calibration` gets a camera's frames, too; may be null.
  LiveWorker(const LiveOptions& options, std::size_t sensor, PipelineConfig config,
             std::mutex* poses, RunningCalibration* calibration = nullptr)
      : options_(options),
        sensor_(sensor),
        config_(std::move(config)),
        poses_(poses),
        calibration_(calibration) {}

  /// Writes a frame's results to the sink, except those `skipped`, then hands it to `watcher`,
  /// which may be null. Unknown results are written as unknown. A new setup makes a new renderer.
  /// Throws DeviceError like Pipeline.
  LiveOutcome judge(AssembledFrame& job, ResultSink& sink, FrameWatcher* watcher = nullptr,
                    std::span<const Result> skipped = {});

 private:
  /// The objects made for a setup.
  struct Tools {
    Session session;
    ResultEncoder encoder;
    std::optional<DepthInput> depth = {};  // of a camera
  };

  [[nodiscard]] Tools make_tools(const SensorSetup& setup) const;
  [[nodiscard]] bool follow(const std::shared_ptr<SensorSetup>& setup);
  void find_warnings(std::int64_t now, LiveOutcome& outcome);
  void show_color(AssembledFrame& job, bool wanted);

  const LiveOptions& options_;
  std::size_t sensor_;
  PipelineConfig config_;
  std::mutex* poses_;
  RunningCalibration* calibration_;
  std::shared_ptr<SensorSetup> setup_;
  std::optional<Tools> tools_;
  std::optional<std::int64_t> next_warnings_;  // on the inbox's clock
  bool has_warned_ = false;                    // about this setup
  std::string fault_;                          // why `tools_` is null
  std::size_t judged_ = 0;
  Image<Rgb8> color_;
};

}  // namespace penumbra::io
