// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::io {

/// Returns the hash by which ROS 2 (Jazzy and later) compares message types, "RIHS01_" and 64 hex
/// digits: the SHA-256 of the type's description as JSON (ROS REP 2011). `type`:
/// "sensor_msgs/msg/Image"; `definition`: its ros2msg text with all types in it
/// (MessageDefinition). Returns an empty string if the text lacks a type.
[[nodiscard]] std::string type_hash(std::string_view type, std::string_view definition);

}  // namespace penumbra::io
