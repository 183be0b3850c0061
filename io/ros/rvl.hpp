// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace penumbra::io {

/// Unpacks depths that were packed with RVL (A. Wilson, "Fast lossless depth image compression",
/// ISS 2017): runs of zeros and of differences, in groups of three bits. Answers what is wrong, or
/// nothing. `packed` must hold all of `depths` and nothing more.
[[nodiscard]] std::optional<std::string> decode_rvl(std::span<const std::byte> packed,
                                                    std::span<std::uint16_t> depths);

}  // namespace penumbra::io
