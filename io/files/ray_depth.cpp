// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include <io/files/ray_depth.hpp>

namespace penumbra::io {

Image<float> z_of_rays(const Camera& camera) {
  const Intrinsics& of = camera.intrinsics;
  Image<float> z(of.width(), of.height());
  for (int v = 0; v < of.height(); ++v)
    for (int u = 0; u < of.width(); ++u)
      if (const auto ray = camera.distortion.undistort(of.ray(u, v).head<2>()))
        z(u, v) = static_cast<float>(1.0 / std::sqrt(1.0 + ray->squaredNorm()));
  return z;
}

SharedDepth along_z(const DepthView& distances, const Image<float>& z_of_ray) {
  Image<float> z = metres_of(distances);
  std::transform(z.data(), z.data() + z.size(), z_of_ray.data(), z.data(), std::multiplies<>());
  return SharedDepth(std::make_shared<const Image<float>>(std::move(z)));
}

}  // namespace penumbra::io
