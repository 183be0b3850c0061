// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

/// A frame's packet, taken apart.
struct Packet {
  nlohmann::json json;
  std::map<std::string, std::string> parts;

  /// Fails the test where the bytes are not what the JSON says.
  explicit Packet(const std::string& bytes) {
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

  /// The float at a byte of a part.
  [[nodiscard]] float float_at(const std::string& part, std::size_t byte = 0) const {
    float number = 0;
    std::memcpy(&number, parts.at(part).data() + byte, sizeof number);
    return number;
  }
};

template <typename T>
std::string bytes_of(ImageView<const T> image) {
  std::string bytes;
  for (int v = 0; v < image.height; ++v)
    bytes.append(reinterpret_cast<const char*>(image.row(v)),
                 sizeof(T) * static_cast<std::size_t>(image.width));
  return bytes;
}
template <typename T>
std::string bytes_of(const Image<T>& image) {
  return bytes_of(image.view());
}

}  // namespace penumbra::test
