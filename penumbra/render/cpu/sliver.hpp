// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include <penumbra/render/cpu/kernel.hpp>

namespace penumbra::cpu {

/// Image points of a triangle's corners as the kernel has them: u and v by turns, pixels.
using ImageCorners = std::array<float, 6>;

/// Whether the triangle has an area in the image and shows its front there. One that has none, or
/// that rounding turned over, covers no pixel centre that its neighbours do not cover.
[[nodiscard]] bool has_area(const ImageCorners& corners);

/// Whether the triangle's box is higher than wide.
[[nodiscard]] bool is_upright(const ImageCorners& corners);

/// A triangle so thin in the image, or seen so nearly edge-on, that the bias of the kernel's edge
/// functions would reach pixels beyond it, and depths that it does not have. Here it is judged in
/// double, without a bias, and depths stay between those of its own sides.
class Sliver {
 public:
  Sliver(const FrameContext& frame, std::uint32_t cluster, std::uint32_t triangle,
         const BodyFrame& body, const ImageCorners& corners);

  /// 1/z at a pixel's centre; 0 where the triangle does not cover it.
  [[nodiscard]] float inverse_depth(int u, int v) const;

 private:
  /// The depths at which the triangle crosses the pixel's column or row: the one that it is more
  /// across to.
  struct Depths {
    double low, high;
  };
  [[nodiscard]] Depths crossing(int u, int v) const;

  const Intrinsics& intrinsics_;
  ImageCorners image_;
  bool upright_;                            // see is_upright
  std::array<Eigen::Vector3d, 3> corners_;  // in the camera's frame
  Eigen::Vector3d normal_;
  double offset_;
};

}  // namespace penumbra::cpu
