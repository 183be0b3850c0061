// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Writes a message, by the built-in definition and with its encapsulation, in place of what
/// `payload` holds. Throws InputError for a stamp that ROS 2 cannot hold, std::length_error for
/// what CDR cannot count.
template <typename M>
void encode(const M& message, std::vector<std::byte>& payload,
            std::endian order = std::endian::little);

}  // namespace penumbra::io
