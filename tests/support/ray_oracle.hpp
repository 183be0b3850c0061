// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra::test {

/// Where a ray meets a surface.
struct RayHit {
  double z;          ///< metres along the optical axis
  std::size_t body;  ///< index
  /// The hit triangle's plane: along any direction d with d.z = 1 it lies at 1/z = inverse_depth.d
  Eigen::Vector3d inverse_depth;
};

/// Casts rays from a camera at the origin of the optical frame. Independent of the renderers.
class RayOracle {
 public:
  virtual ~RayOracle() = default;

  /// The nearest surface, seen from either side, on z * direction with z >= from_z; direction.z
  /// = 1.
  [[nodiscard]] virtual std::optional<RayHit> first_hit(const Eigen::Vector3d& direction,
                                                        double from_z) const = 0;

  /// All surfaces with from_z <= z <= to_z on the ray, in any order.
  [[nodiscard]] virtual std::vector<RayHit> all_hits(const Eigen::Vector3d& direction,
                                                     double from_z, double to_z) const = 0;
};

/// What the oracle sees through every pixel's centre.
struct OracleImage {
  Image<double> depth;         ///< metres; 0: nothing
  Image<std::uint16_t> links;  ///< body index + 1; 0: nothing
};

[[nodiscard]] OracleImage cast_image(const RayOracle& oracle, const Intrinsics& intrinsics);

}  // namespace penumbra::test
