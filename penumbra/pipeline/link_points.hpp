// SPDX-License-Identifier: Apache-2.0
// Points on the robot's surface, and where an image shows them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Returns `count` points of a link's drawn surface, spread evenly by area, in the link's frame,
/// metres; the same for each call. Throws InputError for an unknown link and one that is not drawn.
[[nodiscard]] std::vector<Eigen::Vector3d> points_on(const Robot& robot, std::string_view link,
                                                     std::size_t count);

/// A point of a link in an image.
struct PointView {
  /// visible, hidden, unknown, or out_of_view: outside the image or the lens model, or less than
  /// DepthRenderer::near_plane before the camera.
  Verdict verdict = Verdict::unknown;
  /// Of a hidden point: the value in link images of the link or attached body that hides it, which
  /// may be its own link; 0: something else that the depth image shows.
  std::uint16_t hidden_by = 0;
  /// NaN if the link's pose is unknown, or the camera cannot see there.
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  /// Metres along the optical axis; NaN if the link's pose is unknown.
  double depth = std::numeric_limits<double>::quiet_NaN();
};

/// Returns where a report's image shows points of a link, given in the link's frame, metres.
/// `camera`: Pipeline::report_camera().
///
/// The robot hides a point that lies behind the surface of its virtual depth. What it does not
/// hide is visible if the label of its pixel is occluded, which says that the sensor sees the robot
/// there, and hidden by something else if it is front; other labels say nothing. Without a depth
/// camera (PipelineConfig::has_depth) everything is visible that the robot does not hide. Next to
/// an outline a point may be judged as its neighbour up to 1.5 pixels away, or 3 in raw images of a
/// lens with distortion; more often visible ones are hidden than the reverse. Throws InputError for
/// an unknown link and for a scan.
[[nodiscard]] std::vector<PointView> point_views(const FrameReport& report, const Camera& camera,
                                                 std::string_view link,
                                                 std::span<const Eigen::Vector3d> points);

}  // namespace penumbra
