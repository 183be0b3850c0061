// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <penumbra/fusion/target_fusion.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <io/files/sink.hpp>

namespace penumbra::io {

/// One camera's part of a run, to be fused.
struct CameraRun {
  ViewCamera camera;
  std::vector<CameraFrame> frames;
};

/// Keeps the views of the targets of one camera's run.
class ViewRecorder final : public Sink {
 public:
  ViewRecorder(std::string name, const Pipeline& pipeline)
      : run_{{std::move(name), pipeline.intrinsics(), pipeline.rule().tolerance}, {}} {}

  /// A faulty frame may lack a stamp: it is not fused. Throws InputError for a good one without.
  void take(const Frame& frame, const FrameReport& report) override;

  [[nodiscard]] const CameraRun& run() const { return run_; }

 private:
  CameraRun run_;
};

/// How often a target got each verdict over all cameras.
struct FusedCounts {
  std::string name;
  std::array<std::size_t, all_verdicts.size()> verdicts{};  ///< instants by Verdict
  std::size_t contradictions = 0;

  [[nodiscard]] std::size_t times(Verdict verdict) const {
    return verdicts[static_cast<std::size_t>(verdict)];
  }
};

/// The targets that were judged at one stamp, over all cameras.
struct FusedFrame {
  std::int64_t stamp;  ///< nanoseconds
  std::vector<FusedTarget> targets;
};

/// What a run of several cameras says of its targets.
struct CameraViews {
  std::string input;
  std::vector<std::string> cameras;
  std::vector<FusedFrame> frames;  ///< in the order of their stamps
};

[[nodiscard]] CameraViews fuse_views(const std::string& input, std::span<const CameraRun> runs);

/// Returns the counts by target.
[[nodiscard]] std::vector<FusedCounts> counts_of(const CameraViews& views);

/// Returns the content of views.json (docs/scene.md).
[[nodiscard]] std::string views_json(const CameraViews& views);

/// Returns the cameras of a views.json. Throws InputError if it is none.
[[nodiscard]] std::vector<std::string> cameras_of_views(const std::filesystem::path& file);

}  // namespace penumbra::io
