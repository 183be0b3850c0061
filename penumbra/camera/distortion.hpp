// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

namespace penumbra {

enum class DistortionModel { none, plumb_bob, rational_polynomial, equidistant };

/// ROS's name of the model.
[[nodiscard]] std::string_view to_string(DistortionModel model);

/// The model of that name in ROS's camera_info: "" is none, "fisheye" and "kannala_brandt4" are
/// equidistant. Throws InputError that names an unknown one and lists the known.
[[nodiscard]] DistortionModel distortion_model(std::string_view name);

/// How a lens bends rays. Points are on the plane z = 1 of the optical frame.
///
/// plumb_bob (k1 k2 p1 p2 k3) and rational_polynomial (k1 k2 p1 p2 k3 k4 k5 k6) follow OpenCV's
/// calib3d documentation, equidistant (k1 k2 k3 k4) OpenCV's fisheye documentation
/// (Kannala and Brandt 2006).
///
/// Inside max_radius() the model is one-to-one: distances from the centre grow, and with
/// tangential terms the derivative of distort() is positive definite. No claim is made about
/// points outside: a polynomial folds the image back there.
class Distortion {
 public:
  Distortion() = default;  ///< none

  /// `name` as for distortion_model(). plumb_bob takes 4 coefficients (k3 = 0) or 5,
  /// rational_polynomial 8, or OpenCV's 12 or 14 where those beyond the eighth are 0, and none no
  /// coefficients or only 0. Coefficients that are all 0 of a polynomial model make model() none.
  /// Throws InputError that names an unknown model, a wrong number of coefficients or one that is
  /// not finite.
  Distortion(std::string_view name, std::span<const double> coefficients);

  bool operator==(const Distortion&) const = default;

  [[nodiscard]] DistortionModel model() const { return model_; }
  [[nodiscard]] bool is_none() const { return model_ == DistortionModel::none; }

  /// Where the lens puts the ray through the undistorted point. Beyond max_radius() it is the
  /// formula's value and may be infinite.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& undistorted) const;

  /// Derivative of distort(); a symmetric matrix.
  [[nodiscard]] Eigen::Matrix2d derivative(const Eigen::Vector2d& undistorted) const;

  /// The undistorted point that the lens puts at `distorted`; nothing where the model has no such
  /// point inside max_radius() (or, for equidistant, below 90 degrees).
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  /// Largest undistorted radius up to which the model is one-to-one; infinity where it always is.
  [[nodiscard]] double max_radius() const { return max_radius_; }

 private:
  [[nodiscard]] double radial(double parameter) const;
  [[nodiscard]] double radial_derivative(double parameter) const;
  [[nodiscard]] double excess(double parameter, const Eigen::Vector2d& distorted) const;
  [[nodiscard]] double excess_derivative(double parameter, const Eigen::Vector2d& distorted) const;
  [[nodiscard]] double max_parameter() const;
  [[nodiscard]] double solve(const Eigen::Vector2d& distorted, double end) const;

  DistortionModel model_ = DistortionModel::none;
  // Radial factors by powers of the squared parameter, which is the undistorted radius or, for
  // equidistant, the angle from the optical axis.
  std::array<double, 5> numerator_{1, 0, 0, 0, 0};
  std::array<double, 4> denominator_{1, 0, 0, 0};
  Eigen::Vector2d tangential_ = Eigen::Vector2d::Zero();  // (p2, p1)
  double max_radius_ = std::numeric_limits<double>::infinity();
};

}  // namespace penumbra
