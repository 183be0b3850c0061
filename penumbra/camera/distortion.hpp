// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace penumbra {

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

}  // namespace penumbra
