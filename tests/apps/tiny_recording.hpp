// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace penumbra::test {

/// Size of its images, pixels.
inline constexpr int tiny_width = 64;
inline constexpr int tiny_height = 48;

/// Writes a recording into a folder, which it makes if there is none. It has three frames: a board
/// of 0.4 m x 0.2 m whose near face is 0.95 m + "slide" before the camera, a wall at 3 m, in every
/// frame an object of 8 x 8 pixels at 0.5 m before the board and 8 x 4 pixels without measurement.
/// The board's mesh is board.stl.
void write_tiny_recording(const std::filesystem::path& folder);

}  // namespace penumbra::test
