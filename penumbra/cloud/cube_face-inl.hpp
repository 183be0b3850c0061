// SPDX-License-Identifier: Apache-2.0
// The robot as a sensor in the middle of a cube sees it.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/cloud/scan.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::cloud {

/// What a point is, by the ranges of the robot.
class RangeRule {
 public:
  explicit RangeRule(const CloudRule& rule)
      : a_(static_cast<float>(rule.tolerance.a)),
        b_(static_cast<float>(rule.tolerance.b)),
        c_(static_cast<float>(rule.tolerance.c)),
        k_(static_cast<float>(rule.beyond_factor)),
        mixing_(static_cast<float>(rule.mixing)) {}

  /// `s`: the robot's range on the point's ray.
  [[nodiscard]] Label on_robot(float r, float s) const {
    const float e = tolerance(s);
    if (r < s - e) return Label::front;
    return r > s + k_ * e ? Label::beyond : Label::occluded;
  }
  /// `s`: the robot's range on a ray next to it; known to `spare`.
  [[nodiscard]] bool is_mixed(float r, float s, float spare = 0.0F) const {
    return s - tolerance(s) - spare <= r && r <= s + mixing_ + spare;
  }

 private:
  [[nodiscard]] float tolerance(float s) const { return a_ + (b_ + c_ * s) * s; }

  float a_, b_, c_, k_, mixing_;
};

/// A point as a face shows it.
struct FacePoint {
  Eigen::Vector3f ray;  // to the point, in the face's frame
  float range;
  float u, v;  // image
};

/// What a point is, and by which body: index + 1.
struct PointLabel {
  Label label = Label::clear;
  std::uint16_t link = 0;
};

/// The virtual depth on a face of the cube: 90 degrees, and `border` pixels more for beams.
class CubeFace {
 public:
  static constexpr std::size_t count = 6;  ///< along x, y, z, -x, -y, -z
  static constexpr int size = 1024;        ///< pixels
  static constexpr int border = 16;
  static constexpr float focal = 0.5F * size - border;
  static constexpr float centre = 0.5F * (size - 1);

  /// Returns the rotation from the points' frame to the optical frame of a face.
  [[nodiscard]] static Eigen::Matrix3d frame(std::size_t face);
  /// Returns the face that shows a ray.
  [[nodiscard]] static std::size_t of(const Eigen::Vector3f& ray);
  [[nodiscard]] static Intrinsics intrinsics() {
    return {size, size, focal, focal, centre, centre};
  }
  [[nodiscard]] static FacePoint place(const Eigen::Vector3f& ray) {
    return {ray, ray.norm(), focal * ray.x() / ray.z() + centre,
            focal * ray.y() / ray.z() + centre};
  }

  explicit CubeFace(double beam);

  /// Returns the pixels that may decide the labels of points in this part of the image.
  [[nodiscard]] PixelRectangle window(const Eigen::AlignedBox2f& points) const;

  /// Takes what was rendered, right in the window at least.
  void show(const VirtualDepthView& seen);

  /// Returns whether robot may be in reach of a beam.
  [[nodiscard]] bool holds_robot(const FacePoint& point) const {
    return around_(static_cast<int>(point.u) / cell, static_cast<int>(point.v) / cell) != 0;
  }
  /// Returns the label if the 4 x 4 pixels around the point's ray agree on it: not next to an edge.
  [[nodiscard]] std::optional<PointLabel> label(const FacePoint& point,
                                                const RangeRule& rule) const;
  /// Returns the body, + 1, that the point may be mixed of; 0: none.
  [[nodiscard]] std::uint16_t mixed_link(const FacePoint& point, const RangeRule& rule) const;

 private:
  static constexpr int cell = 4;  // pixels

  float beam_;  // radians, with the least that lets every outline in it hold a pixel's centre
  int reach_;   // pixels
  VirtualDepthView seen_;
  Image<std::uint8_t> cells_, around_;  // 1: robot in a cell, or in reach of it
};

}  // namespace penumbra::cloud
