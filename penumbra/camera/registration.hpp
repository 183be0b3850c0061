// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

/// Transforms depth images of one camera into the image of another: what that camera would measure
/// of the surfaces that the first one sees. The nearest surface in a pixel counts.
///
/// A source pixel covers its footprint on the surface, which extends half-way to its neighbours on
/// the same surface, so that no holes open where the second camera has more pixels or a steeper
/// view. The whole footprint has the pixel's depth: depths are never mixed, and edges stay as sharp
/// as in the source. There is no measurement where the source has none or only the second camera
/// sees.
///
/// A surface next to an object that the first camera cannot measure may appear through that object
/// in the second camera's image: no depth image shows this fault.
class DepthRegistration {
 public:
  /// Depths outside of this range, metres, in either camera are no measurements.
  static constexpr double min_depth = 0.01;
  static constexpr double max_depth = 1e6;

  /// Neighbours are on one surface if its slope, depth by width, is at most this: 83 degrees.
  static constexpr double max_slope = 8.0;

  /// The largest extent of a footprint from its centre, pixels.
  static constexpr int max_reach = 16;

  /// Ignores pixels and rays that a lens model does not reach and depths outside of `from.range`.
  /// Throws InputError as Camera::check.
  DepthRegistration(const Camera& from, const Camera& to);

  /// Returns an image of the size of `to` and the type of `depth`, 0 where nothing is measured,
  /// valid until the next call. Throws std::invalid_argument unless `depth` has the size of `from`,
  /// and InputError for a transform that is not rigid.
  /// Allocates only in the first call with a type.
  DepthView warp(const DepthView& depth, const Eigen::Isometry3d& T_to_from);

 private:
  static constexpr int block = 16;  // pixels that are processed together

  struct Ray {
    float x, y;  // on the plane z = 1; NaN where the lens does not reach
  };
  /// A measured point in the image of `to`.
  struct Landing {
    float u = 0.0F, v = 0.0F;
    float z = 0.0F;      // metres, in `to`
    float depth = 0.0F;  // metres, in `from`; 0: no measurement, or outside of the image
  };
  /// Landings of a row of `from`, with one empty pixel before it and some after it.
  struct Row {
    std::vector<float> u, v, z, depth;
    [[nodiscard]] Landing operator[](std::size_t i) const { return {u[i], v[i], z[i], depth[i]}; }
  };
  struct Box {
    int u0, u1, v0, v1;
  };
  /// Footprints of a block of pixels, valid where all neighbours are on the pixel's surface.
  struct Footprints {
    std::array<int, block> u0, u1, v0, v1;
    std::array<int, block> is_valid;
  };

  [[nodiscard]] Ray ray(int u, int v) const {
    return {rays_x_(u + 1, v + 1), rays_y_(u + 1, v + 1)};
  }
  template <typename T>
  void land_row(ImageView<const T> image, int v, Row& row) const;
  void land_block(const float* depth, int u, int v, Row& row) const;
  void bend_block(int u, Row& row) const;
  void keep_landed(const float* depth, int u, Row& row) const;
  [[nodiscard]] Landing land(const Ray& ray, float depth) const;
  [[nodiscard]] Footprints footprints(int u) const;
  [[nodiscard]] Box footprint_at_edge(int u, int v) const;
  [[nodiscard]] Eigen::Vector2f half_way(const Landing& own, const Landing& other,
                                         const Ray& other_ray, float slope) const;
  template <typename T>
  void splat_row(int v, Image<T>& out) const;
  template <typename T>
  DepthView warp_into(Image<T>& out, ImageView<const T> depth);

  Camera from_;
  Camera to_;
  MeasuredRange range_;
  Image<float> rays_x_, rays_y_;    // of the image and a border of one pixel
  float slope_u_, slope_v_;         // largest relative difference of depth on one surface
  Eigen::Vector2f focal_, centre_;  // of `to`
  Eigen::Matrix3f rotation_;        // T_to_from of this call
  Eigen::Vector3f translation_;
  std::array<Row, 3> rows_;  // above, this, below
  Image<std::uint16_t> millimetres_;
  Image<float> metres_;
};

}  // namespace penumbra
