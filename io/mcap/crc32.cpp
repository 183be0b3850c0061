// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <io/mcap/crc32.hpp>

namespace penumbra::io::mcap {

void Crc32::add(std::span<const std::byte> bytes) {
  const auto* const data = reinterpret_cast<const Bytef*>(bytes.data());
  if (!bytes.empty()) value_ = static_cast<std::uint32_t>(crc32_z(value_, data, bytes.size()));
}

}  // namespace penumbra::io::mcap
