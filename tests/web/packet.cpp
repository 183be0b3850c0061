// SPDX-License-Identifier: Apache-2.0
#include "packet.hpp"

#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>

namespace penumbra::test {

Packet::Packet(const std::string& bytes) {
  std::uint32_t length = 0;
  if (bytes.size() < sizeof length) {
    ADD_FAILURE() << "no packet: " << bytes;
    return;
  }
  std::memcpy(&length, bytes.data(), sizeof length);
  json = nlohmann::json::parse(bytes.substr(sizeof length, length));
  std::size_t at = sizeof length + length;
  for (const auto& part : json["parts"]) {
    const std::size_t size = part["size"];
    EXPECT_LE(at + size, bytes.size());
    parts[part["name"]] = bytes.substr(at, size);
    at += size;
  }
  EXPECT_EQ(at, bytes.size());
}

}  // namespace penumbra::test
