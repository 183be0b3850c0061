// SPDX-License-Identifier: Apache-2.0
// The value that the pipeline's stages pass on. It is complete when it is made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <penumbra/base/image.hpp>
#include <penumbra/cloud/scan.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// A frame with its labels. Without a pose every pixel is unknown. Images of a scan are one row of
/// its points, without depths; `images.labels` are empty if all of them are unknown.
struct LabelledFrame {
  const PoseResult* poses = nullptr;
  FrameStatus status = FrameStatus::ok;
  std::string_view message;       ///< empty if the status is ok
  bool nothing_measured = false;  ///< the depth image has no pixel within the sensor's range
  DepthView depth = {};           ///< the camera's image
  const Scan* scan = nullptr;     ///< of a sensor of points
  LabelledImages images = {};     ///< for targets, which know why something is not drawn
  LabelView labels = {};          ///< the report's
  std::size_t uncovered = 0;      ///< PixelCounts::uncovered
  std::size_t parts = 0;          ///< FrameReport::parts
  std::span<const std::size_t> near_links = {};  ///< FrameReport::near_links
  std::optional<double> render_ms = {}, classify_ms = {};

  [[nodiscard]] std::optional<std::int64_t> stamp() const { return poses->stamp; }
  /// Returns one line about its fault.
  [[nodiscard]] std::string fault() const {
    return (status == FrameStatus::ok ? "" : std::string(to_string(status)) + ": ") +
           std::string(message);
  }
};

}  // namespace penumbra
