// SPDX-License-Identifier: Apache-2.0
// OpenCV as the oracle of the lens models.
#include "lens_samples.hpp"

#include <opencv2/calib3d.hpp>

namespace penumbra::test {
namespace {

constexpr double same_px = 1e-9;  // both compute the same formula in double, in another order
constexpr double opencv_focal = 1000;

std::vector<cv::Point2d> project_by_opencv(const Lens& sample, const Distortion& lens,
                                           const std::vector<cv::Point3d>& points) {
  const cv::Mat k = (cv::Mat_<double>(3, 3) << opencv_focal, 0, 0, 0, opencv_focal, 0, 0, 0, 1);
  const cv::Vec3d none(0, 0, 0);
  std::vector<cv::Point2d> pixels;
  if (lens.model() == DistortionModel::equidistant)
    cv::fisheye::projectPoints(points, pixels, none, none, k, sample.coefficients);
  else
    cv::projectPoints(points, none, none, k, sample.coefficients, pixels);
  return pixels;
}

void compare(const Lens& sample, std::mt19937_64& random) {
  const Distortion lens = sample.distortion();
  std::vector<Vector2d> rays;
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 200; ++i) {
    rays.push_back(random_point_inside(lens, 0.99, random));
    points.emplace_back(rays.back().x(), rays.back().y(), 1.0);
  }
  const auto expected = project_by_opencv(sample, lens, points);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vector2d pixel = opencv_focal * lens.distort(rays[i]);
    const double scale =
        std::max(1.0, pixel.norm() / opencv_focal);  // near a pole, pixels are far apart
    EXPECT_LT((pixel - Vector2d(expected[i].x, expected[i].y)).norm(), same_px * scale)
        << sample.name << ' ' << sample.model << ' ' << rays[i].transpose();
  }
}

TEST(DistortionAgainstOpenCv, TypicalAndRandomLenses) {
  auto random = seeded_random(11);
  for (const Lens& sample : typical_lenses()) compare(sample, random);
  random = seeded_random(12);
  for (int i = 0; i < 500; ++i) compare(random_lens(random), random);
}

}  // namespace
}  // namespace penumbra::test
