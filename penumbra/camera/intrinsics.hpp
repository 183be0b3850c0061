// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace penumbra {

/// A pinhole camera's image size and projection. Pixel (u, v) has its centre at integer
/// coordinates: its ray is ((u - cx) / fx, (v - cy) / fy, 1) in the optical frame (x right, y down,
/// z forward), as in OpenCV and ROS. The principal point may lie anywhere, outside the image too.
class Intrinsics {
 public:
  static constexpr int max_size = 32767;      ///< largest width or height
  static constexpr int max_pixels = 1 << 26;  ///< largest width times height; 8 K has half of it
  static constexpr double max_focal = 1e7;    ///< largest fx or fy; telescopes have 1e5

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

}  // namespace penumbra
