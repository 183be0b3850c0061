// SPDX-License-Identifier: Apache-2.0
// The values that the pipeline's stages hand on. Each is complete when it is made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// Where the robot and its camera were at a frame's stamp; with a fault of the poses, no links.
struct PoseResult {
  std::optional<std::int64_t> stamp;     ///< nanoseconds
  FrameStatus status = FrameStatus::ok;  ///< all faults but those that the depth image itself shows
  std::string_view message;              ///< of a status that is not ok
  std::span<const Eigen::Isometry3d> T_root_link = {};
  std::span<const Eigen::Isometry3d> T_camera_link = {};
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  LinkDoubts doubts = {};

  [[nodiscard]] bool known() const { return !T_root_link.empty(); }
};

/// A frame's images, labelled. Without a pose every pixel is unknown.
struct LabelledFrame {
  PoseResult poses;
  FrameStatus status = FrameStatus::ok;
  std::string_view message;       ///< of a status that is not ok
  bool nothing_measured = false;  ///< no pixel of the depth image is within the sensor's range
  DepthView depth;                ///< the camera's image
  LabelledImages images = {};
  std::size_t uncovered = 0;  ///< PixelCounts::uncovered

  [[nodiscard]] std::optional<std::int64_t> stamp() const { return poses.stamp; }
};

/// The status that makes more of the frame unknown; the earlier one of two that make the same.
[[nodiscard]] FrameStatus worse(FrameStatus a, FrameStatus b);

/// Adds a part to a line of them.
void add_part(std::string& line, std::string_view part);

}  // namespace penumbra
