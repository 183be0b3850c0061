// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>
#include <sim/random.hpp>

namespace penumbra::sim {

/// Returns a print with corners and blobs of many sizes, so that features are found at any
/// distance.
[[nodiscard]] Image<Rgb8> busy_print(int width, int height, Random& random);

/// Returns one colour with a fine grain.
[[nodiscard]] Image<Rgb8> grain(int width, int height, Rgb8 color, int amplitude, Random& random);

}  // namespace penumbra::sim
