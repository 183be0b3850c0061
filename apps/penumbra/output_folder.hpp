// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/robot/robot.hpp>

#include <apps/penumbra/arguments.hpp>
#include <io/frame_reader.hpp>
#include <io/target_overlay.hpp>

namespace penumbra::app {

/// Digits of a frame's index in file names, at least.
inline constexpr std::size_t frame_digits = 6;

/// What overlays need to show a frame's targets.
struct ShownTargets {
  std::span<const Target> targets;
  const Robot& robot;
  const Camera& camera;  ///< of the report's images
};

/// Where `run` writes. Files are named by the frame's index: vdi/000000.npy, labels/000000.png.
class OutputFolder {
 public:
  /// Makes the folder and those of the images to save. `rectification` brings recorded images to
  /// the report's; null where they fit, else it must outlive this. Throws InputError where the
  /// folder is refused.
  OutputFolder(const std::filesystem::path& folder, const Saves& saves,
               const Rectification* rectification);

  [[nodiscard]] std::filesystem::path report_file() const { return folder_ / "report.json"; }

  /// Writes the frame's images. Where the robot's pose is unknown there is no VDI and no link
  /// image, and all labels are unknown. Throws InputError where writing fails.
  void save(const FrameReport& report, const io::FrameData& frame, const ShownTargets& targets);

 private:
  [[nodiscard]] std::filesystem::path file(const char* kind, std::size_t index,
                                           const char* ending) const;
  void save_overlay(const FrameReport& report, const io::FrameData& frame,
                    const ShownTargets& targets);

  template <typename T>
  ImageView<const T> seen(const Image<T>& raw, Image<T>& rectified);
  Image<std::uint16_t>& depth_of(const Image<std::uint16_t>&) { return millimetres_; }
  Image<float>& depth_of(const Image<float>&) { return metres_; }

  std::filesystem::path folder_;
  Saves saves_;
  const Rectification* rectification_;
  Image<io::Rgb8> color_;
  Image<std::uint16_t> millimetres_;
  Image<float> metres_;
  Image<io::Rgb8> overlay_;
  io::TargetOverlay target_overlay_;
};

}  // namespace penumbra::app
