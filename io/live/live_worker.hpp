// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <penumbra/session/session.hpp>

#include <io/assembly/depth_input.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/live/frame_watcher.hpp>
#include <io/live/live_inbox.hpp>

namespace penumbra::io {

/// What LiveWorker is set to.
struct LiveWorkerOptions {
  PipelineConfig config = {};  ///< the camera's pose and parent are replaced by those of each setup
  DriftLimits limits = {};
  PointsRule points = {};
  CloudOutput clouds = {};
  std::mutex* poses = nullptr;  ///< guards the robot's poses; null: nobody changes them
  RunningCalibration* calibration = nullptr;  ///< gets a camera's frames, too
};

/// Judges the frames of one sensor. Use one thread at a time, without the lock of the poses.
class LiveWorker {
 public:
  explicit LiveWorker(LiveWorkerOptions options) : options_(std::move(options)) {}

  /// Writes a frame's results to the sink, then hands it to `watcher`, which may be null.
  /// Unknown results are written as unknown. A new setup makes a new renderer. Throws DeviceError
  /// like Pipeline.
  LiveOutcome judge(AssembledFrame& job, ResultSink& sink, FrameWatcher* watcher = nullptr);

 private:
  /// The objects made for a setup.
  struct Tools {
    Session session;
    // Of a camera, or of a sensor of points:
    std::optional<DepthInput> depth = {};
    std::optional<ResultEncoder> encoder = {};
    std::optional<CloudEncoder> cloud_encoder = {};
  };

  [[nodiscard]] Tools make_tools(const SensorSetup& setup) const;
  [[nodiscard]] bool follow(const std::shared_ptr<SensorSetup>& setup);
  void write_image(const AssembledFrame& job, const FrameReport& report, ResultSink& sink,
                   LiveOutcome& outcome);
  void find_warnings(std::int64_t now, LiveOutcome& outcome);
  void show_color(const AssembledFrame& job, bool wanted);

  LiveWorkerOptions options_;
  std::shared_ptr<SensorSetup> setup_;
  std::optional<Tools> tools_;
  std::optional<std::int64_t> next_warnings_;  // on the inbox's clock
  bool has_warned_ = false;                    // about this setup
  std::string fault_;                          // why `tools_` is null
  std::size_t judged_ = 0;
  Image<Rgb8> color_;
};

}  // namespace penumbra::io
