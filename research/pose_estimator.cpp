// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <penumbra/base/error.hpp>

#include <research/pose_estimator.hpp>

namespace penumbra::research {
namespace {

constexpr float ratio = 0.8F;          // Lowe 2004, section 7.1
constexpr double ransac_pixels = 3.0;  // reprojection error of an inlier
constexpr int ransac_rounds = 300;     // more than 99.9 % need for 40 % inliers
constexpr double ransac_confidence = 0.999;
constexpr double least_pixel_sigma = 0.5;  // features are not found more exactly

/// Returns a matrix that must not be written to: OpenCV has none of constant pixels.
cv::Mat matrix_of(ImageView<const Rgb8> image) {
  return {image.height, image.width, CV_8UC3, const_cast<Rgb8*>(image.data),
          static_cast<std::size_t>(image.stride) * sizeof(Rgb8)};
}

cv::Mat grey_of(const cv::Mat& color) {
  cv::Mat grey;
  cv::cvtColor(color, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

struct Correspondences {
  std::vector<cv::Point3f> points;
  std::vector<cv::Point2f> pixels;

  [[nodiscard]] Correspondences of(const std::vector<int>& indices) const {
    Correspondences some;
    for (const int i : indices) {
      some.points.push_back(points[static_cast<std::size_t>(i)]);
      some.pixels.push_back(pixels[static_cast<std::size_t>(i)]);
    }
    return some;
  }
};

Eigen::Isometry3d pose_of(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  cv::Mat rotation;
  cv::Rodrigues(rotation_vector, rotation);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.linear()(i, j) = rotation.at<double>(i, j);
    pose.translation()(i) = translation.at<double>(i);
  }
  return pose;
}

struct Solution {
  Eigen::Isometry3d pose;
  Correspondences inliers;
};

/// A plane has two possible poses. IPPE returns the one that fits better; OpenCV's other solvers
/// return either. OpenCV throws for degenerate points (on a line): there is no pose then.
std::optional<Solution> solve(const Correspondences& all, const cv::Mat& camera) try {
  cv::Mat rotation, translation;
  std::vector<int> agreed;
  if (!cv::solvePnPRansac(all.points, all.pixels, camera, cv::noArray(), rotation, translation,
                          false, ransac_rounds, static_cast<float>(ransac_pixels),
                          ransac_confidence, agreed, cv::SOLVEPNP_P3P))
    return std::nullopt;
  Correspondences inliers = all.of(agreed);
  if (!cv::solvePnP(inliers.points, inliers.pixels, camera, cv::noArray(), rotation, translation,
                    false, cv::SOLVEPNP_IPPE))
    return std::nullopt;
  cv::solvePnPRefineLM(inliers.points, inliers.pixels, camera, cv::noArray(), rotation,
                       translation);
  return Solution{pose_of(rotation, translation), std::move(inliers)};
} catch (const cv::Exception&) {
  return std::nullopt;
}

/// Returns the covariance of least squares, sigma^2 (J^T J)^-1. J is the reprojection's derivative
/// by position and rotation vector.
Matrix6d covariance_of(const Intrinsics& camera, const Eigen::Isometry3d& pose,
                       const Correspondences& inliers) {
  Matrix6d information = Matrix6d::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < inliers.points.size(); ++i) {
    const cv::Point3f& point = inliers.points[i];
    const Eigen::Vector3d turned = pose.linear() * Eigen::Vector3d(point.x, point.y, point.z);
    const Eigen::Vector3d p = turned + pose.translation();
    Eigen::Matrix<double, 2, 3> by_point;
    by_point << camera.fx() / p.z(), 0, -camera.fx() * p.x() / (p.z() * p.z()), 0,
        camera.fy() / p.z(), -camera.fy() * p.y() / (p.z() * p.z());
    Eigen::Matrix<double, 2, 6> jacobian;
    jacobian << by_point, -by_point * cross_matrix(turned);
    information += jacobian.transpose() * jacobian;
    const Eigen::Vector2d seen(inliers.pixels[i].x, inliers.pixels[i].y);
    squares += (camera.project(p) - seen).squaredNorm();
  }
  const double freedom = 2.0 * static_cast<double>(inliers.points.size()) - 6.0;
  const double variance = std::max(squares / freedom, least_pixel_sigma * least_pixel_sigma);
  return variance * information.inverse();
}

}  // namespace

struct PoseEstimator::State {
  Intrinsics camera;
  cv::Mat matrix;
  cv::Ptr<cv::SIFT> sift = cv::SIFT::create();
  std::vector<Eigen::Vector3d> model_points;
  cv::Mat model_descriptors;
};

PoseEstimator::PoseEstimator(const Camera& camera, ImageView<const Rgb8> front,
                             const Eigen::Vector3d& size)
    : state_(new State{camera.intrinsics,
                       (cv::Mat_<double>(3, 3) << camera.intrinsics.fx(), 0, camera.intrinsics.cx(),
                        0, camera.intrinsics.fy(), camera.intrinsics.cy(), 0, 0, 1),
                       cv::SIFT::create(),
                       {},
                       {}}) {
  if (!camera.distortion.is_none())
    throw InputError("the pose estimator takes pinhole images only; rectify them first");
  cv::setNumThreads(1);  // seeds run side by side
  std::vector<cv::KeyPoint> keys;
  state_->sift->detectAndCompute(grey_of(matrix_of(front)), cv::noArray(), keys,
                                 state_->model_descriptors);
  for (const cv::KeyPoint& key : keys) {
    const double x = (static_cast<double>(key.pt.x) + 0.5) / front.width - 0.5;
    const double y = 0.5 - (static_cast<double>(key.pt.y) + 0.5) / front.height;
    state_->model_points.emplace_back(x * size.x(), y * size.y(), 0.5 * size.z());
  }
}

PoseEstimator::~PoseEstimator() = default;

std::vector<FeatureMatch> PoseEstimator::match(ImageView<const Rgb8> color,
                                               const PixelBox& part) const {
  const auto cut = [](double value, int most) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  const int u0 = cut(std::floor(part.u), color.width), v0 = cut(std::floor(part.v), color.height);
  const int u1 = cut(std::ceil(part.u + part.width), color.width);
  const int v1 = cut(std::ceil(part.v + part.height), color.height);
  constexpr int least = 8;  // pixels in which a feature can be
  if (u1 - u0 < least || v1 - v0 < least) return {};
  std::vector<cv::KeyPoint> keys;
  cv::Mat descriptors;
  state_->sift->detectAndCompute(grey_of(matrix_of(color)(cv::Rect(u0, v0, u1 - u0, v1 - v0))),
                                 cv::noArray(), keys, descriptors);
  if (descriptors.empty() || state_->model_points.size() < 2) return {};
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_L2).knnMatch(descriptors, state_->model_descriptors, nearest, 2);
  std::map<int, cv::DMatch> best;  // of each of the model's points
  for (const auto& two : nearest) {
    if (two[0].distance >= ratio * two[1].distance) continue;
    const auto [at, is_new] = best.try_emplace(two[0].trainIdx, two[0]);
    if (!is_new && two[0].distance < at->second.distance) at->second = two[0];
  }
  std::vector<FeatureMatch> matches;
  for (const auto& [model, found] : best) {
    const cv::Point2f& at = keys[static_cast<std::size_t>(found.queryIdx)].pt;
    matches.push_back(
        {Eigen::Vector2d(static_cast<double>(at.x) + u0, static_cast<double>(at.y) + v0),
         state_->model_points[static_cast<std::size_t>(model)]});
  }
  return matches;
}

std::optional<PoseGuess> PoseEstimator::estimate(std::span<const FeatureMatch> matches,
                                                 ImageView<const std::uint8_t> mask,
                                                 Acceptance acceptance) const {
  constexpr std::size_t least_of_eager = 4;
  const std::size_t least = acceptance == Acceptance::careful ? min_inliers : least_of_eager;
  Correspondences all;
  for (const FeatureMatch& match : matches) {
    const int u = static_cast<int>(std::lround(match.pixel.x()));
    const int v = static_cast<int>(std::lround(match.pixel.y()));
    if (u < 0 || v < 0 || u >= mask.width || v >= mask.height || mask(u, v) == 0) continue;
    all.points.emplace_back(match.point.cast<float>().x(), match.point.cast<float>().y(),
                            match.point.cast<float>().z());
    all.pixels.emplace_back(match.pixel.cast<float>().x(), match.pixel.cast<float>().y());
  }
  if (all.points.size() < least) return std::nullopt;
  const auto found = solve(all, state_->matrix);
  if (!found || found->inliers.points.size() < least) return std::nullopt;
  PoseGuess guess;
  guess.T_camera_object = found->pose;
  guess.inliers = found->inliers.points.size();
  const Eigen::Vector3d normal = guess.T_camera_object.linear().col(2);
  const bool faces_camera = normal.dot(guess.T_camera_object.translation()) < 0;
  if (!guess.T_camera_object.matrix().allFinite() || guess.T_camera_object.translation().z() <= 0 ||
      !faces_camera)
    return std::nullopt;
  if (acceptance == Acceptance::careful) {
    guess.covariance = covariance_of(state_->camera, guess.T_camera_object, found->inliers);
    if (!guess.covariance->allFinite()) return std::nullopt;
  }
  return guess;
}

}  // namespace penumbra::research
