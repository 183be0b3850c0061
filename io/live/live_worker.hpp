// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <penumbra/session/session.hpp>

#include <io/assembly/depth_input.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/live/frame_watcher.hpp>
#include <io/live/live_inbox.hpp>

namespace penumbra::io {

/// Judges the images of one camera. Use one thread at a time; no lock is needed meanwhile.
class LiveWorker {
 public:
  /// `config`: the camera's pose and parent are replaced by those of each setup.
  explicit LiveWorker(PipelineConfig config, const DriftLimits& limits = {},
                      const PointsRule& points = {})
      : config_(std::move(config)), limits_(limits), points_(points) {}

  /// Writes an image's results to the sink, then hands the frame to `watcher`, which may be null.
  /// Unknown results are written as unknown. A new setup makes a new renderer. Throws DeviceError
  /// like Pipeline.
  LiveOutcome judge(AssembledFrame& job, ResultSink& sink, FrameWatcher* watcher = nullptr);

 private:
  /// The objects made for a setup.
  struct Tools {
    Tools(const CameraSetup& setup, const PipelineConfig& config, const DriftLimits& limits,
          const PointsRule& points);
    Session session;
    ResultEncoder encoder;
    DepthInput depth;
  };

  [[nodiscard]] bool follow(const std::shared_ptr<CameraSetup>& setup);
  void find_warnings(std::int64_t now, LiveOutcome& outcome);
  void show_color(const AssembledFrame& job, bool wanted);

  PipelineConfig config_;
  DriftLimits limits_;
  PointsRule points_;
  std::shared_ptr<CameraSetup> setup_;
  std::unique_ptr<Tools> tools_;
  std::optional<std::int64_t> next_warnings_;  // on the inbox's clock
  bool has_warned_ = false;                    // about this setup
  std::string fault_;                          // why `tools_` is null
  std::size_t judged_ = 0;
  Image<Rgb8> color_;
};

}  // namespace penumbra::io
