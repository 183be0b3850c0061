// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace example {

/// Small PNG files; rows without gaps. Throws std::runtime_error if the file cannot be written.
void write_grey8(const std::filesystem::path& file, int width, int height,
                 std::vector<std::uint8_t> pixels);
void write_grey16(const std::filesystem::path& file, int width, int height,
                  const std::vector<std::uint16_t>& pixels);
void write_rgb8(const std::filesystem::path& file, int width, int height,
                std::vector<std::uint8_t> pixels);

}  // namespace example
