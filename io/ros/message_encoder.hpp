// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Replaces the content of `payload` by a message with its encapsulation. Throws InputError for a
/// stamp that ROS 2 cannot hold, std::length_error for a sequence that CDR cannot hold.
template <typename M>
void encode(const M& message, std::vector<std::byte>& payload);

}  // namespace penumbra::io
