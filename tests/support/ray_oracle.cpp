// SPDX-License-Identifier: Apache-2.0
#include "ray_oracle.hpp"

#include "pixels.hpp"

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::test {

OracleImage cast_image(const RayOracle& oracle, const Intrinsics& intrinsics) {
  OracleImage image{{intrinsics.width(), intrinsics.height()},
                    {intrinsics.width(), intrinsics.height()}};
  for (const auto [u, v] : each_pixel(intrinsics)) {
    const auto hit = oracle.first_hit(intrinsics.ray(u, v), DepthRenderer::near_plane);
    if (!hit) continue;
    image.depth(u, v) = hit->z;
    image.links(u, v) = std::uint16_t(hit->body + 1);
  }
  return image;
}

}  // namespace penumbra::test
