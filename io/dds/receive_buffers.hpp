// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace penumbra::io {

/// Returns the largest receive buffer in bytes that the kernel allows a socket (net.core.rmem_max),
/// or nothing if it is not known.
[[nodiscard]] std::optional<std::uint64_t> receive_buffer_limit();

/// Returns advice if the limit loses images with best effort QoS, or an empty text.
[[nodiscard]] std::string receive_buffer_advice(std::optional<std::uint64_t> limit);

}  // namespace penumbra::io
