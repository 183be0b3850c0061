// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/target.hpp>

#include <io/files/frame_pattern.hpp>

namespace penumbra::io {

/// The context of targets.
struct TargetsContext {
  static constexpr double default_history = 0.5;  ///< seconds

  const Robot& robot;                      ///< its links may be named
  ImageSpace image;                        ///< of the report
  Intrinsics images;                       ///< of the report's images
  bool has_distortion;                     ///< the camera's raw images have lens distortion
  bool beyond_hides;                       ///< default of targets
  double history = default_history;        ///< seconds that frames are kept for late targets
  std::string_view camera_frame = {};      ///< of the report's images; empty: it has no name
  std::optional<FrameStamps> stamps = {};  ///< of the frames, for files named by time (%t)
};

/// A targets.yaml or a detector's file (docs/targets.md): which targets each frame has.
class TargetsFile {
 public:
  /// Reads the file and the CSV files, masks and meshes that it names; masks of single frames are
  /// read with their frame. Throws InputError that names file, line and key for unknown, doubled or
  /// missing keys, wrong values, names used twice, and pixels of another image than the report's.
  [[nodiscard]] static TargetsFile open(const std::filesystem::path& file,
                                        const TargetsContext& context);
  ~TargetsFile();
  TargetsFile(TargetsFile&&) noexcept;
  TargetsFile& operator=(TargetsFile&&) noexcept;

  /// Compares the detections' frames with those of the recording, ascending. Throws InputError if
  /// none is of these frames, or all are only if they are numbered from another frame.
  void check_frames(std::span<const std::int64_t> frames);

  /// Returns what is doubtful about the detections, one line each.
  [[nodiscard]] const std::vector<std::string>& notes() const;

  /// Returns all targets in the file's order, then those of the frame's detections. A target
  /// without a valid value in this frame has a fault and no shape.
  [[nodiscard]] std::vector<Target> of_frame(std::int64_t index) const;

  [[nodiscard]] const std::filesystem::path& file() const;
  [[nodiscard]] std::size_t size() const;  ///< without detections

  /// Returns the PipelineConfig::target_history that they need, seconds.
  [[nodiscard]] double history() const;

 private:
  struct State;
  explicit TargetsFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::io
