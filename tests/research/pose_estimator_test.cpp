// SPDX-License-Identifier: Apache-2.0
// The oracle is a ray caster of a textured rectangle, written here.
#include "../support/test.hpp"

#include <research/pose_estimator.hpp>

namespace penumbra::test {
namespace {

using research::PoseEstimator;

const Eigen::Vector3d size(0.20, 0.15, 0.08);
const PixelBox everywhere{0, 0, 640, 480};

Camera camera() { return {Intrinsics(640, 480, 600, 600, 310, 245), {}, {}, {}}; }

/// Rectangles of random colours: corners at every scale.
Image<Rgb8> busy_image(std::mt19937_64& random) {
  Image<Rgb8> image(320, 240, {128, 128, 128});
  const auto any = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  for (int i = 0; i < 400; ++i) {
    const int u0 = any(310), v0 = any(230), w = 4 + any(40), h = 4 + any(40);
    const Rgb8 color{static_cast<std::uint8_t>(any(256)), static_cast<std::uint8_t>(any(256)),
                     static_cast<std::uint8_t>(any(256))};
    for (const auto [u, v] : each_pixel(u0, v0, std::min(u0 + w, 320), std::min(v0 + h, 240)))
      image(u, v) = color;
  }
  return image;
}

/// What the camera sees of the print at u, v; grey beside it.
Eigen::Vector3d seen_at(const Image<Rgb8>& print, const Eigen::Isometry3d& T_object_camera,
                        double u, double v) {
  const Eigen::Vector3d from = T_object_camera.translation();
  const Eigen::Vector3d to = T_object_camera.linear() * camera().intrinsics.ray(u, v);
  const double t = (0.5 * size.z() - from.z()) / to.z();
  const Eigen::Vector3d p = from + t * to;
  const int x = static_cast<int>(std::floor((p.x() / size.x() + 0.5) * print.width()));
  const int y = static_cast<int>(std::floor((0.5 - p.y() / size.y()) * print.height()));
  if (t <= 0 || x < 0 || y < 0 || x >= print.width() || y >= print.height()) return {90, 90, 90};
  const Rgb8& c = print(x, y);
  return {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
}

Image<Rgb8> view_of(const Image<Rgb8>& print, const Eigen::Isometry3d& T_camera_object) {
  constexpr int rays = 2;  // in each direction of a pixel
  const Eigen::Isometry3d T_object_camera = T_camera_object.inverse();
  Image<Rgb8> image(640, 480);
  for (const auto [u, v] : each_pixel(image)) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto [k, i] : each_pixel(0, 0, rays, rays))
      sum +=
          seen_at(print, T_object_camera, u + (k + 0.5) / rays - 0.5, v + (i + 0.5) / rays - 0.5);
    sum /= rays * rays;
    image(u, v) = {static_cast<std::uint8_t>(sum.x()), static_cast<std::uint8_t>(sum.y()),
                   static_cast<std::uint8_t>(sum.z())};
  }
  return image;
}

/// The front faces the camera; tilted by up to 35 degrees.
Eigen::Isometry3d random_pose(std::mt19937_64& random) {
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(0.6 * one(random), Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(0.6 * one(random), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(M_PI * one(random), Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.1 * one(random), 0.08 * one(random), 0.9);
  return pose;
}

// SIFT finds corners to about a fifth of a pixel; over hundreds of them and 0.9 m of distance that
// is far less than these.
constexpr double most_distance = 0.004, most_angle = 0.02;  // metres, radians
constexpr double most_sigmas = 6.0;  // the claimed covariance holds features for independent

/// An object with a print of its own, and who looks for it.
struct Bench {
  explicit Bench(std::uint64_t seed) : random(seeded_random(seed)) {}

  std::mt19937_64 random;
  const Image<Rgb8> print = busy_image(random);
  const PoseEstimator estimator{camera(), print.view(), size};
  const Image<std::uint8_t> whole{640, 480, 255};
};

TEST(PoseEstimator, FindsThePoseThatARayCasterDrew) {
  Bench bench(4);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Isometry3d truth = random_pose(bench.random);
    const Image<Rgb8> image = view_of(bench.print, truth);
    const auto matches = bench.estimator.match(image.view(), everywhere);
    const auto guess = bench.estimator.estimate(matches, bench.whole.view());
    ASSERT_TRUE(guess) << "view " << i << ", " << matches.size() << " matches";
    const Eigen::Vector3d off = guess->T_camera_object.translation() - truth.translation();
    const Eigen::AngleAxisd turn(truth.linear().transpose() * guess->T_camera_object.linear());
    EXPECT_LT(off.norm(), most_distance);
    EXPECT_LT(turn.angle(), most_angle);
    const Eigen::Matrix3d covariance = guess->covariance->topLeftCorner<3, 3>();
    EXPECT_LT(std::sqrt(off.dot(covariance.inverse() * off)), most_sigmas);
    EXPECT_GE(guess->inliers, PoseEstimator::min_inliers);
  }
}

TEST(PoseEstimator, LooksOnlyWhereTheMaskIs) {
  Bench bench(5);
  const PoseEstimator& estimator = bench.estimator;
  const Image<Rgb8> image = view_of(bench.print, random_pose(bench.random));
  const auto matches = estimator.match(image.view(), everywhere);
  const Image<std::uint8_t> nowhere(640, 480, 0);
  EXPECT_FALSE(estimator.estimate(matches, nowhere.view()));
  Image<std::uint8_t> half(640, 480, 0);
  for (int v = 0; v < 480; ++v) std::fill(half.view().row(v), half.view().row(v) + 310, 255);
  const auto some = estimator.estimate(matches, half.view());
  const auto all = estimator.estimate(matches, bench.whole.view());
  ASSERT_TRUE(some && all);
  EXPECT_LT(some->inliers, all->inliers);
  EXPECT_GT(some->covariance->trace(), all->covariance->trace());
}

TEST(PoseEstimator, ClaimsNothingWhereTheObjectIsNot) {
  Bench bench(6);
  for (int i = 0; i < 3; ++i) {
    const Image<Rgb8> other = view_of(busy_image(bench.random), random_pose(bench.random));
    const auto matches = bench.estimator.match(other.view(), everywhere);
    EXPECT_FALSE(bench.estimator.estimate(matches, bench.whole.view()));
  }
}

}  // namespace
}  // namespace penumbra::test
