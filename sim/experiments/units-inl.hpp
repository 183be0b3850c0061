// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace penumbra::sim {

/// Of metres and radians: what reports tell.
inline constexpr double millimetres = 1e3, degrees = 180.0 / M_PI;

}  // namespace penumbra::sim
