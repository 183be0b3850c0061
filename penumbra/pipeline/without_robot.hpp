// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/base/setting.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// A depth image that owns its pixels: millimetres or metres, as DepthView.
using DepthImage = std::variant<Image<std::uint16_t>, Image<float>>;

/// Copies the report's depth without the robot. Pixels that are not labelled clear or front become
/// 0 (uint16) or NaN (float32), and so do all pixels of a frame without depth. `out` gets the size
/// of the labels and the type of the depth; without depth it keeps its type.
void without_robot(const FrameReport& report, DepthImage& out);

/// Points, metres, in the order of their pixels.
struct PointCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> pixels;  ///< of each point: v * width + u
};

/// Which points are made of an image; by default all: 3.7 MB for 640x480 pixels.
struct PointsRule {
  int stride = 1;
  double range = 0.0;
  double voxel = 0.0;

  static constexpr auto settings() {
    return std::tuple(
        Setting("points_stride", &PointsRule::stride, {1, 64}, "",
                "points of each N-th pixel of each N-th row only"),
        Setting("points_range", &PointsRule::range, {0, 1000}, "m",
                "points up to this distance from the camera only; 0: all"),
        Setting("points_voxel", &PointsRule::voxel, {0, 10}, "m",
                "one point, the first, in each cube of this size, 0.001 or more; 0: all points"));
  }

  /// Throws InputError for settings out of range.
  void check() const;
};

/// Converts one camera's depth images to points. Allocates nothing once a cloud is large enough.
class CloudMaker {
 public:
  /// `camera`: of the images; for images of reports, with Pipeline::intrinsics(). Throws InputError
  /// for settings out of range.
  explicit CloudMaker(const Camera& camera, const PointsRule& rule = {});

  /// Writes a point for each measurement inside the lens model that the rule leaves, in the frame
  /// of `T_frame_camera`, in which cubes lie; by default the camera's optical frame. The image must
  /// have the camera's size.
  void make(const DepthImage& depth, PointCloud& cloud,
            const Eigen::Isometry3d& T_frame_camera = Eigen::Isometry3d::Identity());

 private:
  [[nodiscard]] bool is_first_in_cube(const Eigen::Vector3f& point);

  PointsRule rule_;
  std::vector<std::uint64_t> cubes_;  // a hash table of those with a point; 0: a free place
  std::uint64_t last_cube_ = 0;
  Image<float> rays_x_, rays_y_;  // x / z and y / z of a pixel's ray; NaN outside the lens model
};

/// Returns the pose T_link_camera of the optical frame in a link's frame, metres; null if the
/// report has no pose. Throws InputError for an unknown link.
[[nodiscard]] std::optional<Eigen::Isometry3d> camera_in_link(const FrameReport& report,
                                                              std::string_view link);

/// Returns 255 where the robot, or what it carries, is drawn, else 0: which pixels of a picture
/// show it, if nothing stands before it.
[[nodiscard]] Image<std::uint8_t> robot_mask(const VirtualDepthView& virtual_depth);
/// The same of a pose, for example {.positions = ...}, in the camera's own image; 0 where its lens
/// model does not reach. For many frames use a Session. Throws InputError if the mask would lack
/// something: the camera's pose or joint positions are missing, not finite or not one for each of
/// Robot::variables(), one is beyond its joint's limits by more than their range, a mesh could not
/// be read, or a part is within 1 cm of the camera.
[[nodiscard]] Image<std::uint8_t> robot_mask(const Robot& robot, const Camera& camera,
                                             const RobotPose& pose);

/// Returns 255 where the rendered robot stands before what a depth image shows, else 0: what to
/// paint of another robot over that scene. It is in front up to the tolerance behind the measured
/// depth, and where nothing is measured. Throws InputError for images of different sizes.
[[nodiscard]] Image<std::uint8_t> front_of(const ImageView<const float>& virtual_depth,
                                           const DepthView& measured,
                                           const Tolerance& tolerance = {});

}  // namespace penumbra
