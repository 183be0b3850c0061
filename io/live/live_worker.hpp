// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/assembly/depth_input.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/live/frame_watcher.hpp>
#include <io/live/live_job.hpp>

namespace penumbra::io {

/// Judges the images of one camera. One instance serves one thread at a time; no lock is needed
/// while it works.
class LiveWorker {
 public:
  /// `config`: its camera's pose and parent are the setups' own.
  explicit LiveWorker(PipelineConfig config) : config_(std::move(config)) {}

  /// Writes an image's results to the sink, then hands the frame to `watcher`, which may be null.
  /// What is not known is written as unknown. For another setup than before renderer and all are
  /// made anew. Throws DeviceError as Pipeline does.
  LiveOutcome judge(LiveJob& job, ResultSink& sink, FrameWatcher* watcher = nullptr);

 private:
  /// What is made for a setup.
  struct Tools {
    Tools(const LiveSetup& setup, const PipelineConfig& config);
    Pipeline pipeline;
    ResultEncoder encoder;
    DepthInput depth;
  };

  [[nodiscard]] bool follow(const std::shared_ptr<LiveSetup>& setup);
  [[nodiscard]] std::string read_depth(const LiveJob& job, DepthView& depth);
  void show_color(const LiveJob& job, bool wanted);

  PipelineConfig config_;
  std::shared_ptr<LiveSetup> setup_;
  std::unique_ptr<Tools> tools_;
  std::string fault_;    // why there are no tools
  std::string message_;  // of the frame
  std::size_t judged_ = 0;
  DepthView no_depth_;  // of the images' kind
  Image<Rgb8> color_;
};

}  // namespace penumbra::io
