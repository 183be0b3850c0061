// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace penumbra::io {

/// The most bytes that the kernel lets a socket hold for its reader (net.core.rmem_max); nothing
/// where it does not tell.
[[nodiscard]] std::optional<std::uint64_t> receive_buffer_limit();

/// What to do where that limit costs images with QoS best effort; empty: nothing.
[[nodiscard]] std::string receive_buffer_advice(std::optional<std::uint64_t> limit);

}  // namespace penumbra::io
