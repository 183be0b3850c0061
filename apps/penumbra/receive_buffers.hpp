// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace penumbra::app {

/// The kernel's sizes of a socket's receive buffer in bytes; nothing if not known.
struct ReceiveBuffers {
  std::optional<std::uint64_t> limit;   ///< net.core.rmem_max: Penumbra and Cyclone DDS use it
  std::optional<std::uint64_t> normal;  ///< net.core.rmem_default: Fast DDS uses it
};
[[nodiscard]] ReceiveBuffers receive_buffers();

/// Returns advice if the limit loses images that Penumbra receives with best effort QoS, or an
/// empty text.
[[nodiscard]] std::string limit_advice(const ReceiveBuffers& buffers);
/// The same for results that nodes on Fast DDS, ROS 2's default, receive on this machine.
[[nodiscard]] std::string normal_advice(const ReceiveBuffers& buffers);

}  // namespace penumbra::app
