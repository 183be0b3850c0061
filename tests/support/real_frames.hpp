// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra::test {

/// A recorded depth image beside the robot rendered at its pose.
struct RealFrame {
  Intrinsics intrinsics;
  Image<float> robot;  ///< virtual depth, metres
  TileMask tiles;
  Image<std::uint16_t> measured;        ///< millimetres
  std::size_t mask_pixels = 0;          ///< of robot_mask_N.png, the robot seen in the colour image
  std::vector<int> robot_indices = {};  ///< v * width + u of the robot's pixels

  /// The shared recordings have only air around the arm in these rows.
  [[nodiscard]] int air_rows() const { return robot.width() == 1280 ? 420 : 320; }
  [[nodiscard]] VirtualDepthView view() const {
    return {.depth = robot.view(), .links = {}, .touched = &tiles};
  }
};

/// Reads a recording of a rectified camera without lens distortion, with the masks that its folder
/// holds, and renders the robot with the reference renderer. Throws InputError.
[[nodiscard]] std::vector<RealFrame> load_real_frames(const std::filesystem::path& recording);

}  // namespace penumbra::test
