// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

/// Brings depth images of one camera into the image of another: what that would measure of the
/// surfaces that the first one sees. Of those in one pixel the nearest is taken.
///
/// A source pixel covers its footprint on the surface, which reaches half-way to its neighbours on
/// the same surface, so that no holes open where the second camera has more pixels or looks
/// steeper. Its depth stands in all of it: depths are never mixed, and an edge between surfaces is
/// as sharp as in the source. Where the source has no measurement, and where only the second camera
/// sees, there is none.
///
/// What the first camera sees beside something that it cannot measure may show through that: the
/// second one looks past the edge. That is no fault that a depth image could tell.
class DepthRegistration {
 public:
  /// Depths outside of these, metres, in either camera are no measurements: nearer, a pixel would
  /// cover much of an image; farther, millimetres do not reach (of uint16), or nothing does.
  static constexpr double min_depth = 0.01;
  static constexpr double max_depth = 1e6;

  /// Neighbours are on one surface if that is no steeper than this, of depth by width: 83 degrees.
  static constexpr double max_slope = 8.0;

  /// Pixels that a footprint reaches from its centre, at most.
  static constexpr int max_reach = 16;

  /// Both lenses may have distortion; pixels and rays that a lens model does not reach are left
  /// out, and depths outside of `from.range`. Throws InputError as Camera::check.
  DepthRegistration(const Camera& from, const Camera& to);

  /// `depth` must have the size of `from`, or std::invalid_argument is thrown; the result has the
  /// size of `to`, the kind of `depth`, 0 where nothing is measured, and is valid until the next
  /// call. Allocates nothing after the first of its kind.
  DepthView warp(const DepthView& depth, const Eigen::Isometry3d& T_to_from);

 private:
  static constexpr int block = 16;  // pixels that are worked on at a time

  struct Ray {
    float x, y;  // on the plane z = 1; NaN where the lens does not reach
  };
  /// A measured point in the image of `to`.
  struct Landing {
    float u = 0.0F, v = 0.0F;
    float z = 0.0F;      // metres, in `to`
    float depth = 0.0F;  // metres, in `from`; 0: nothing is measured, or it lands nowhere
  };
  /// Landings of a row of `from`, with a pixel that is nowhere before it, and some behind.
  struct Row {
    std::vector<float> u, v, z, depth;
    void resize(std::size_t size);
    [[nodiscard]] Landing operator[](std::size_t i) const { return {u[i], v[i], z[i], depth[i]}; }
  };
  struct Box {
    int u0, u1, v0, v1;
  };
  struct Span {
    float u0, u1, v0, v1;
  };
  /// Footprints of a block of pixels amid a surface; of others they mean nothing.
  struct Footprints {
    std::array<int, block> u0, u1, v0, v1;
    std::array<int, block> amid;  // whether all neighbours are on the pixel's surface
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
  [[nodiscard]] Box box_of(const Span& span, const Landing& own) const;
  [[nodiscard]] Eigen::Vector2f half_way(const Landing& own, const Landing& other,
                                         const Ray& other_ray, float slope) const;
  template <typename T>
  void splat_row(int v, Image<T>& out) const;
  template <typename T>
  DepthView warp_into(Image<T>& out, ImageView<const T> depth);

  Camera from_;
  Camera to_;
  Image<float> rays_x_, rays_y_;    // of the image and a pixel around it
  float slope_u_, slope_v_;         // of depth by depth, between neighbours of one surface
  Eigen::Vector2f focal_, centre_;  // of `to`
  Eigen::Matrix3f rotation_;        // T_to_from of this call
  Eigen::Vector3f translation_;
  std::array<Row, 3> rows_;  // above, this, below
  Image<std::uint16_t> millimetres_;
  Image<float> metres_;
};

}  // namespace penumbra
