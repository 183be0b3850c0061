// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra::io {

/// Returns the z-component of a metre along each pixel's ray; 0: the lens model does not reach it.
[[nodiscard]] Image<float> z_of_rays(const Camera& camera);

/// Returns depth for distances along the rays, in metres. Both images are of the same size.
[[nodiscard]] SharedDepth along_z(const DepthView& distances, const Image<float>& z_of_ray);

}  // namespace penumbra::io
