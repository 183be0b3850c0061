// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>

namespace penumbra {

/// A pinhole camera's image size and projection. Pixel (u, v) has its centre at integer
/// coordinates: its ray is ((u - cx) / fx, (v - cy) / fy, 1) in the optical frame (x right, y down,
/// z forward), as in OpenCV and ROS. The principal point may lie anywhere, outside the image too.
class Intrinsics {
 public:
  static constexpr int max_size = 32767;       ///< largest width or height
  static constexpr int max_pixels = 1 << 26;   ///< largest width times height; 8 K has half of it
  static constexpr double max_focal = 1e7;     ///< largest fx or fy; telescopes have 1e5
  static constexpr double least_focal = 0.01;  ///< of the width: a view of 178 degrees

  /// Lengths in pixels. Throws InputError, with the values, unless 0 < fx, fy <= max_focal,
  /// cx and cy are finite, 1 <= width, height <= max_size and width * height <= max_pixels.
  Intrinsics(int width, int height, double fx, double fy, double cx, double cy);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] double fx() const { return fx_; }
  [[nodiscard]] double fy() const { return fy_; }
  [[nodiscard]] double cx() const { return cx_; }
  [[nodiscard]] double cy() const { return cy_; }

  /// Returns the camera whose pixels each cover a block of bx x by pixels: cx' = (cx + 0.5) / bx -
  /// 0.5. Throws InputError unless the block is at least one pixel and at most the image.
  [[nodiscard]] Intrinsics binned(int bx, int by) const;

  /// Returns the camera of a window of this image that starts at (x, y). Throws InputError unless
  /// the window lies inside the image.
  [[nodiscard]] Intrinsics cropped(int x, int y, int width, int height) const;

  /// Returns the ray of image point (u, v), with z = 1.
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const {
    return {(u - cx_) / fx_, (v - cy_) / fy_, 1.0};
  }

  /// Returns the image of a point in the optical frame; z must not be 0.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {fx_ * p.x() / p.z() + cx_, fy_ * p.y() / p.z() + cy_};
  }

  bool operator==(const Intrinsics&) const = default;

 private:
  int width_, height_;
  double fx_, fy_, cx_, cy_;
};

enum class DistortionModel { none, plumb_bob, rational_polynomial, equidistant };

/// Returns ROS's name of the model.
[[nodiscard]] std::string_view to_string(DistortionModel model);

/// Returns the model of a name in ROS's camera_info: "" is none, "fisheye" and "kannala_brandt4"
/// are equidistant. Throws InputError for unknown names.
[[nodiscard]] DistortionModel distortion_model(std::string_view name);

/// The distortion of a lens. Points are on the plane z = 1 of the optical frame.
///
/// plumb_bob (k1 k2 p1 p2 k3) and rational_polynomial (k1 k2 p1 p2 k3 k4 k5 k6) follow OpenCV's
/// calib3d documentation, equidistant (k1 k2 k3 k4) OpenCV's fisheye documentation
/// (Kannala and Brandt 2006).
///
/// Inside max_radius() the model is one-to-one: distances from the centre grow, and with tangential
/// terms the derivative of distort() is positive definite. Outside, a polynomial folds the image
/// back.
class Distortion {
 public:
  Distortion() = default;  ///< none

  /// `name` as for distortion_model(). plumb_bob needs 4 coefficients (k3 = 0) or 5;
  /// rational_polynomial 8, or OpenCV's 12 or 14 if those after the eighth are 0; none any number
  /// of 0. A polynomial model whose coefficients are all 0 becomes none. Throws InputError for an
  /// unknown model, a wrong number of coefficients or one that is not finite.
  Distortion(std::string_view name, std::span<const double> coefficients);

  bool operator==(const Distortion&) const = default;

  [[nodiscard]] DistortionModel model() const { return model_; }
  [[nodiscard]] bool is_none() const { return model_ == DistortionModel::none; }

  /// Returns the model's 5, 8 or 4 coefficients, which make the same distortion; empty for none.
  [[nodiscard]] std::vector<double> coefficients() const;

  /// Returns the image of an undistorted point. Beyond max_radius() it may be infinite.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& undistorted) const;

  /// Returns the derivative of distort(), a symmetric matrix.
  [[nodiscard]] Eigen::Matrix2d derivative(const Eigen::Vector2d& undistorted) const;

  /// Returns the inverse of distort(); nothing if there is no such point inside max_radius() (or,
  /// for equidistant, below 90 degrees).
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  /// Returns the undistorted radius up to which the model is one-to-one: at most 100 for polynomial
  /// models; infinity for none and for an equidistant model that is one-to-one up to 90 degrees.
  [[nodiscard]] double max_radius() const { return max_radius_; }

 private:
  [[nodiscard]] double radial(double parameter) const;
  [[nodiscard]] double radial_derivative(double parameter) const;
  [[nodiscard]] double excess(double parameter, const Eigen::Vector2d& distorted) const;
  [[nodiscard]] double excess_derivative(double parameter, const Eigen::Vector2d& distorted) const;
  [[nodiscard]] double find_max_parameter() const;
  [[nodiscard]] double solve(const Eigen::Vector2d& distorted, double end) const;

  DistortionModel model_ = DistortionModel::none;
  // Radial factors by powers of the squared parameter: the undistorted radius or, for equidistant,
  // the angle from the optical axis.
  std::array<double, 5> numerator_{1, 0, 0, 0, 0};
  std::array<double, 4> denominator_{1, 0, 0, 0};
  Eigen::Vector2d tangential_ = Eigen::Vector2d::Zero();  // (p2, p1)
  double max_radius_ = std::numeric_limits<double>::infinity();
  double max_parameter_ = std::numeric_limits<double>::infinity();
};

/// The sensor's range, metres: depths outside of it are no measurements. It does not limit what is
/// rendered.
struct DepthRange {
  double near = 0.0;
  double far = std::numeric_limits<double>::infinity();

  bool operator==(const DepthRange&) const = default;
};

/// A calibrated depth camera, and where it is.
struct Camera {
  Intrinsics intrinsics;       ///< of the image as received
  Distortion distortion = {};  ///< of the image as received; none if it is already rectified
  DepthRange range = {};
  std::string frame_id = {};  ///< the optical frame; may be empty

  std::string parent = {};  ///< link that carries the camera; empty: the root
  /// Pose of the optical frame in that link's frame, metres; null: not known. What needs it then
  /// throws InputError: it is never taken for the identity.
  std::optional<Eigen::Isometry3d> T_parent_camera = {};

  bool operator==(const Camera& other) const {
    return intrinsics == other.intrinsics && distortion == other.distortion &&
           range == other.range && frame_id == other.frame_id && parent == other.parent &&
           T_parent_camera.has_value() == other.T_parent_camera.has_value() &&
           (!T_parent_camera || T_parent_camera->matrix() == other.T_parent_camera->matrix());
  }

  /// Returns the pose. Throws InputError if it is not known.
  [[nodiscard]] const Eigen::Isometry3d& pose() const {
    if (!T_parent_camera)
      throw InputError(
          "camera: its pose is missing; set T_parent_camera, the pose of the optical frame (x "
          "right, y down, z forward) in the frame of link 'parent', metres");
    return *T_parent_camera;
  }

  /// Returns itself. Throws InputError, with the values, unless 0 <= near < far.
  const Camera& check() const {
    if (!(range.near >= 0 && range.near < range.far))
      throw InputError("camera: the range from " + std::to_string(range.near) + " to " +
                       std::to_string(range.far) + " metres must be 0 <= near < far");
    return *this;
  }
};

}  // namespace penumbra
