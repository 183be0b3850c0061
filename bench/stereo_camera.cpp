// SPDX-License-Identifier: Apache-2.0
#include "stereo_camera.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace penumbra::study {
namespace {

constexpr double ambient = 70.0;          // grey levels of a white surface
constexpr double projected = 180.0;       // the pattern's, at 1 m
constexpr double camera_noise = 1.5;      // grey levels, standard deviation
constexpr double speckle_sigma = 0.8;     // pixels
constexpr int disparities = 96;           // pixels: 0.31 m is the nearest depth
constexpr int block = 9;                  // pixels
constexpr float steps_per_pixel = 16.0F;  // of OpenCV's disparities

cv::Mat matrix(Image<float>& image) {
  return {image.height(), image.width(), CV_32F, image.data()};
}
cv::Mat matrix(Image<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8U, image.data()};
}

/// Random speckles from 0 to 1, half of them dark.
Image<float> speckles(int width, int height, sim::Random& random) {
  Image<float> image(width, height);
  std::generate_n(image.data(), image.size(), [&] { return static_cast<float>(random.uniform()); });
  cv::Mat pixels = matrix(image);
  cv::GaussianBlur(pixels, pixels, {}, speckle_sigma);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.data()[i] = std::clamp(0.5F + 4.0F * (image.data()[i] - 0.5F), 0.0F, 1.0F);
  return image;
}

Image<float> white_noise(int width, int height, sim::Random& random) {
  Image<float> image(width, height);
  std::generate_n(image.data(), image.size(), [&] { return static_cast<float>(random.normal()); });
  return image;
}

}  // namespace

struct StereoCamera::Matcher {
  cv::Ptr<cv::StereoSGBM> matcher =
      cv::StereoSGBM::create(0, disparities, block, 8 * block * block, 32 * block * block, 1, 63,
                             10, 100, 2, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat disparity;
};

StereoCamera::StereoCamera(const Intrinsics& intrinsics, std::uint64_t seed)
    : intrinsics_(intrinsics),
      random_(seed, 41),
      pattern_(speckles(intrinsics.width(), intrinsics.height(), random_)),
      noise_(white_noise(1024, 1024, random_)),
      matcher_(std::make_unique<Matcher>()) {
  cv::setNumThreads(1);  // the study has its own threads
}

StereoCamera::~StereoCamera() = default;

/// `from_left`: metres between this camera and the left one, where the projector is.
void StereoCamera::light(const Image<Rgb8>& color, const Image<float>& depth, double from_left,
                         Image<std::uint8_t>& grey) {
  grey.fit(intrinsics_.width(), intrinsics_.height());
  const int last = intrinsics_.width() - 1;
  const auto shift = static_cast<float>(intrinsics_.fx() * from_left);
  std::size_t at_noise = random_.bits() % noise_.size();
  for (int v = 0; v < color.height(); ++v) {
    const float* const pattern = pattern_.view().row(v);
    for (int u = 0; u <= last; ++u) {
      const Rgb8 rgb = color(u, v);
      const float albedo = static_cast<float>(rgb.r + rgb.g + rgb.b) / (3.0F * 255.0F);
      const float z = depth(u, v) > 0.0F ? depth(u, v) : 1e3F;
      const float x = std::min(static_cast<float>(u) + shift / z, static_cast<float>(last));
      const int x0 = std::min(static_cast<int>(x), last - 1);
      const float part = x - static_cast<float>(x0);
      const float lit = (1.0F - part) * pattern[x0] + part * pattern[x0 + 1];
      const float value =
          albedo * (static_cast<float>(ambient) + static_cast<float>(projected) * lit / (z * z)) +
          static_cast<float>(camera_noise) * noise_.data()[at_noise];
      at_noise = at_noise + 1 == noise_.size() ? 0 : at_noise + 1;
      grey(u, v) = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  }
}

void StereoCamera::capture(sim::Stage& stage, const Eigen::Isometry3d& T_base_left,
                           StereoImages& images) {
  const sim::Viewpoint left{intrinsics_, T_base_left};
  const sim::Viewpoint right{intrinsics_, T_base_left * Eigen::Translation3d(baseline, 0.0, 0.0)};
  const sim::Window whole{0, 0, intrinsics_.width(), intrinsics_.height()};
  const auto everything = [](std::int32_t) { return true; };
  images.ids.fit(intrinsics_.width(), intrinsics_.height());
  images.depth.fit(intrinsics_.width(), intrinsics_.height());
  right_depth_.fit(intrinsics_.width(), intrinsics_.height());
  images.measured.fit(intrinsics_.width(), intrinsics_.height());
  stage.draw_ids(left, everything, whole, &images.ids, &images.depth);
  stage.draw_ids(right, everything, whole, nullptr, &right_depth_);
  stage.draw_color(left, color_);
  light(color_, images.depth, 0.0, images.left);
  stage.draw_color(right, color_);
  light(color_, right_depth_, baseline, images.right);
  matcher_->matcher->compute(matrix(images.left), matrix(images.right), matcher_->disparity);
  const auto focal_baseline = static_cast<float>(intrinsics_.fx() * baseline);
  for (int v = 0; v < images.measured.height(); ++v) {
    const auto* const disparity = matcher_->disparity.ptr<std::int16_t>(v);
    for (int u = 0; u < images.measured.width(); ++u)
      images.measured(u, v) =
          disparity[u] <= 0
              ? std::uint16_t{0}
              : static_cast<std::uint16_t>(std::min(
                    65534.0F, 1000.0F * focal_baseline * steps_per_pixel / disparity[u] + 0.5F));
  }
}

}  // namespace penumbra::study
