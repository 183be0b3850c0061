// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

namespace penumbra::test {

/// A frame's packet, taken apart.
struct Packet {
  nlohmann::json json;
  std::map<std::string, std::string> parts;

  /// Fails the test where the bytes are not what the JSON says.
  explicit Packet(const std::string& bytes);
};

}  // namespace penumbra::test
