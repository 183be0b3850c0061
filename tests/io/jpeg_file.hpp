// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::test {

/// A JPEG file of quality 95, without subsampling.
std::vector<std::byte> jpeg_of(const Image<Rgb8>& image, bool progressive);

}  // namespace penumbra::test
