// SPDX-License-Identifier: Apache-2.0
// Points on the robot's surface, and where an image shows them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
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

/// Says where images show points of a robot's links, and what hides them.
class PointJudge {
 public:
  /// Surfaces that are closer to a point along its ray are the point's own, metres.
  static constexpr double same_surface = 1e-4;

  /// Makes a tree of each mesh, which takes some milliseconds.
  explicit PointJudge(const Robot& robot);

  /// Judges points of a link, given in the link's frame, metres. `report`: of this robot. `camera`:
  /// Pipeline::report_camera().
  ///
  /// The robot hides a point if the ray from the camera meets a link before the point, or the pixel
  /// shows an attached body before it. What the robot does not hide is visible if its pixel's label
  /// is occluded: the sensor sees the robot there. It is hidden by something else if the label is
  /// front, and unknown for other labels. Without a depth camera (PipelineConfig::has_depth) all is
  /// visible that the robot does not hide. While a part of the robot is not drawn, nothing is
  /// visible. Throws InputError for an unknown link, for a scan and for points that are not finite.
  [[nodiscard]] std::vector<PointView> judge(const FrameReport& report, const Camera& camera,
                                             std::string_view link,
                                             std::span<const Eigen::Vector3d> points) const;

 private:
  struct Trees;
  std::shared_ptr<const Trees> trees_;
};

}  // namespace penumbra
