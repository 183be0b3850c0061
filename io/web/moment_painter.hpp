// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/camera/rectification.hpp>
#include <penumbra/planning/look_ahead.hpp>
#include <penumbra/render/depth_renderer.hpp>

#include <io/files/overlay_painter.hpp>
#include <io/web/report_page.hpp>

namespace penumbra::io {

/// Draws the robot, as it will be, and the targets into the colour image of now.
class MomentPainter {
 public:
  /// `color`: as the camera recorded it with the robot at `start`; empty: the picture is grey, as
  /// it is once the camera has moved. Robot and targets must outlive this.
  MomentPainter(const Robot& robot, const ForecastCamera& camera, ImageView<const Rgb8> color,
                std::span<const ForecastTarget> targets, const RobotPose& start);

  /// Adds pictures of the first camera where a target gets hidden, a few, and of the end, to a
  /// page. `motion`: the trajectory's index there.
  void add_pictures(const Trajectory& trajectory, std::span<const TargetForecast> forecasts,
                    std::size_t motion, std::vector<PagePicture>& page);

 private:
  [[nodiscard]] Image<Rgb8> draw(std::span<const double> positions,
                                 std::span<const TargetForecast> forecasts, double time);

  const Robot& robot_;
  std::span<const ForecastTarget> targets_;
  std::size_t parent_;
  Eigen::Isometry3d T_parent_camera_, T_root_camera_;  // the latter at the start
  std::vector<AttachedBody> attached_;
  std::optional<Rectification> rectification_;
  Camera camera_;  // of the pictures
  Image<Rgb8> background_;
  std::unique_ptr<DepthRenderer> renderer_;
};

}  // namespace penumbra::io
