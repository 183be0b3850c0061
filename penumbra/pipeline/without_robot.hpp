// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// A depth image that owns its pixels: millimetres or metres, as DepthView.
using DepthImage = std::variant<Image<std::uint16_t>, Image<float>>;

/// Copies the report's depth without the robot. Pixels are 0 (uint16) or NaN (float32) unless their
/// label is clear or front; all of them where a link is missing, or the frame has no depth or pose.
/// `out` gets the size of the report's labels and the type of its depth; without depth it keeps its
/// type.
void without_robot(const FrameReport& report, DepthImage& out);

/// Points, metres, in the order of their pixels.
struct PointCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> pixels;  ///< of each point: v * width + u
};

/// Makes points of one camera's depth images. Allocates nothing once a cloud is large enough.
class CloudMaker {
 public:
  /// `camera`: of the images; of the reports, where it is made for them.
  explicit CloudMaker(const Camera& camera);

  /// A point for each measurement that the lens model reaches, in the frame that `T_frame_camera`
  /// leads to: by default the camera's optical frame. The image must have the camera's size.
  void make(const DepthImage& depth, PointCloud& cloud,
            const Eigen::Isometry3d& T_frame_camera = Eigen::Isometry3d::Identity()) const;

 private:
  Image<float> rays_x_, rays_y_;  // x / z and y / z of a pixel's ray; NaN: none
};

/// Pose T_link_camera of the optical frame in a link's frame, metres; nothing where the report has
/// no pose. Throws InputError for a name that is no link.
[[nodiscard]] std::optional<Eigen::Isometry3d> camera_in_link(const FrameReport& report,
                                                              std::string_view link);

}  // namespace penumbra
