// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>

namespace penumbra {

/// A virtual depth image: what the camera would measure if there were only the robot.
struct VirtualDepthView {
  ImageView<const float> depth;          ///< metres along the optical axis; 0: no robot on the ray
  ImageView<const std::uint16_t> links;  ///< link index + 1 of the nearest surface; 0: none
  const TileMask* touched = nullptr;     ///< outside of these tiles depth and links are 0
};

}  // namespace penumbra
