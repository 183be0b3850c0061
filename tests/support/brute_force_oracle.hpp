// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ray_oracle.hpp"

#include <array>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::test {

/// Tests every triangle against every ray, in extended precision where rounding could matter. For
/// small scenes whose coordinates are too large, too small or too skewed for single precision.
class BruteForceOracle final : public RayOracle {
 public:
  BruteForceOracle(std::span<const Body> bodies, std::span<const Eigen::Isometry3d> T_camera_body);

  [[nodiscard]] std::optional<RayHit> first_hit(const Eigen::Vector3d& direction,
                                                double from_z) const override;
  [[nodiscard]] std::vector<RayHit> all_hits(const Eigen::Vector3d& direction, double from_z,
                                             double to_z) const override;

 private:
  template <typename F>
  void for_each_hit(const Eigen::Vector3d& direction, F&& f) const;

  struct Triangle {
    std::array<Eigen::Vector3d, 3> corners;  // optical frame
    std::array<Eigen::Vector3d, 3> sides;    // normals of the planes through the origin and an edge
    std::array<double, 3> doubt;             // bound of the rounding error of a unit ray . side
    Eigen::Vector3d middle;                  // unit rays through the triangle have at least this
    double least;                            // cosine to its middle; below -1 if it is very wide
    std::size_t body;
  };
  std::vector<Triangle> triangles_;
};

}  // namespace penumbra::test
