// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/tuning/tuning.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// A mesh that was written for a link.
struct WrittenExtra {
  std::string link;
  std::string file;  ///< its name in the folder of results
};

/// Returns tune.json. The frames are named by their index.
[[nodiscard]] std::string tuning_json(const Tuning& tuning, std::span<const KeptFrame> frames,
                                      std::span<const WrittenExtra> extras);

/// Draws the frame with the most fringe: its colour, or its depth in grey if `color` is empty; the
/// robot's outline; pixels that the recommended rule removes in green, those that it leaves in red.
[[nodiscard]] Image<Rgb8> draw_tuning(const Tuning& tuning, const KeptFrame& frame,
                                      ImageView<const Rgb8> color);

}  // namespace penumbra::io
