// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace penumbra {

enum class DistortionModel { none, plumb_bob, rational_polynomial, equidistant };

/// ROS's name of the model.
[[nodiscard]] std::string_view to_string(DistortionModel model);

/// How a lens bends rays. Points are on the plane z = 1 of the optical frame.
///
/// plumb_bob (k1 k2 p1 p2 k3) and rational_polynomial (k1 k2 p1 p2 k3 k4 k5 k6) follow OpenCV's
/// calib3d documentation, equidistant (k1 k2 k3 k4) OpenCV's fisheye documentation
/// (Kannala and Brandt 2006).
class Distortion {
 public:
  Distortion() = default;  ///< none

  /// `name` as in ROS's camera_info ("" or "none" need no coefficients). Coefficients that are all
  /// 0 of a polynomial model make model() none. Throws InputError that names an unknown model, a
  /// wrong number of coefficients or one that is not finite.
  Distortion(std::string_view name, std::span<const double> coefficients);

  [[nodiscard]] DistortionModel model() const { return model_; }
  [[nodiscard]] bool is_none() const { return model_ == DistortionModel::none; }

  /// Where the lens puts the ray through the undistorted point.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& undistorted) const;

  /// The undistorted point that the lens puts at `distorted`; nothing where the model has no such
  /// point inside its monotone radius (or, for equidistant, at 90 degrees and beyond).
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  /// Largest undistorted radius up to which the model is monotone; infinity where it always is.
  [[nodiscard]] double max_radius() const { return max_radius_; }

 private:
  DistortionModel model_ = DistortionModel::none;
  std::vector<double> coefficients_;
  double max_radius_ = 0.0;
};

}  // namespace penumbra
