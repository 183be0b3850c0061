// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/occlusion/label_work-inl.hpp>

namespace penumbra::labelling {

/// Finds the fringe (LabelRule): a flood from the robot's measured outline into clear pixels.
class FringeFill {
 public:
  FringeFill(int width, int height, int reach);

  /// Labels the fringe in `work` and marks its tiles as touched. Returns its number of pixels.
  std::size_t label(Work& work, const DepthView& measured);

 private:
  /// A pixel whose depth, metres, is the robot's, and the pixel of the outline that it comes from.
  struct Pixel {
    std::int16_t u, v, from_u, from_v;
    float depth, from_depth;
  };

  template <typename T>
  void find_outline(const Work& work, ImageView<const T> measured);
  template <typename T>
  void flood(Work& work, ImageView<const T> measured);

  int reach_;
  std::vector<Pixel> queue_;
  std::vector<std::uint8_t*> once_;        // pixels that one neighbour has reached
  std::vector<std::uint8_t> column_, square_;  // least label of 3 x 1 and 3 x 3 pixels of a row
};

}  // namespace penumbra::labelling
