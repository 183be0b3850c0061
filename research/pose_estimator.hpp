// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/tracking/trackers.hpp>

#include <io/files/png.hpp>

namespace penumbra::research {

/// A point of the object's front, found in the image.
struct FeatureMatch {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< in the object's frame, metres
};

struct PoseGuess {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  /// Of position and rotation vector, optical frame; none from an eager estimator.
  std::optional<Matrix6d> covariance;
  std::size_t inliers = 0;
};

/// When an estimator gives a pose.
enum class Acceptance {
  careful,  ///< from at least PoseEstimator::min_inliers, with a covariance
  eager     ///< whenever RANSAC finds four that agree, as OpenCV does; no covariance
};

/// Finds a flat textured object: matches SIFT features to its image by the ratio test, and solves
/// PnP with RANSAC. The same input gives the same pose.
class PoseEstimator {
 public:
  static constexpr std::size_t min_inliers = 10;  ///< of a careful estimator

  /// `front`: the image on the +z face of a box of `size` metres about the object's origin, its u
  /// along +x and its v along -y. Throws InputError for a camera with lens distortion.
  PoseEstimator(const Camera& camera, ImageView<const Rgb8> front, const Eigen::Vector3d& size);
  ~PoseEstimator();

  /// Returns the object's features in a part of the image.
  [[nodiscard]] std::vector<FeatureMatch> match(ImageView<const Rgb8> color,
                                                const PixelBox& part) const;

  /// Returns the pose from the matches whose pixel is not 0 in the mask; nothing if they do not
  /// agree on one.
  [[nodiscard]] std::optional<PoseGuess> estimate(
      std::span<const FeatureMatch> matches, ImageView<const std::uint8_t> mask,
      Acceptance acceptance = Acceptance::careful) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::research
