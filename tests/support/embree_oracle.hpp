// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ray_oracle.hpp"

#include <memory>
#include <span>

#include <Eigen/Geometry>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::test {

/// Casts rays with Embree, in its robust mode. Embree works in single precision: it finds the
/// triangle, whose depth on the ray is then computed in double from the unrounded corners.
class EmbreeOracle final : public RayOracle {
 public:
  EmbreeOracle(std::span<const Body> bodies, std::span<const Eigen::Isometry3d> T_camera_body);
  ~EmbreeOracle() override;
  EmbreeOracle(EmbreeOracle&&) noexcept;
  EmbreeOracle& operator=(EmbreeOracle&&) noexcept;

  [[nodiscard]] std::optional<RayHit> first_hit(const Eigen::Vector3d& direction,
                                                double from_z) const override;
  [[nodiscard]] std::vector<RayHit> all_hits(const Eigen::Vector3d& direction, double from_z,
                                             double to_z) const override;

  /// Whether the camera's centre lies inside a closed body: a ray into any of several directions
  /// first meets the back of a triangle that is wound outwards.
  [[nodiscard]] bool camera_is_inside() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace penumbra::test
