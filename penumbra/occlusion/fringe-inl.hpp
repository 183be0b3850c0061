// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/occlusion/label_work-inl.hpp>

namespace penumbra::labelling {

/// Finds the fringe (LabelRule): a flood over blocks of 2 x 2 pixels.
class FringeFill {
 public:
  FringeFill(int width, int height, int reach);

  /// Labels the fringe in `work` and marks its tiles as touched. Returns its number of pixels.
  std::size_t label(Work& work, const DepthView& measured);

 private:
  /// A block on the robot's outline, and the depths that the flood from it may take: those in
  /// [nearest, farthest] that differ from their neighbour's by at most `step`, millimetres.
  struct Source {
    std::uint16_t nearest, farthest, step;
    std::int16_t x, y;
  };
  struct Block {
    std::int16_t x, y;
    std::uint32_t source;  ///< index in sources_
    std::uint16_t depth;   ///< millimetres
  };

  template <typename T>
  void fill_blocks(const Work& work, ImageView<const T> measured);
  void find_sources(const Work& work);
  void add_source(const Rule& rule, int x, int y, std::uint16_t depth);
  void flood();
  template <typename T>
  std::size_t paint(Work& work, ImageView<const T> measured) const;

  [[nodiscard]] std::uint16_t* block(int x, int y) {
    return &blocks_[static_cast<std::size_t>(y + 1) * pitch_ + static_cast<std::size_t>(x + 1)];
  }

  int reach_;
  std::size_t pitch_;
  /// Near the robot, with a rim of zeros: of each block the nearest depth of its occluded pixels,
  /// in millimetres; without any that of its clear pixels, with the bit is_open; without any 0.
  std::vector<std::uint16_t> blocks_;
  std::vector<Source> sources_;
  std::unique_ptr<Block[]> queue_;  // the sources' blocks, then those that the flood took
  std::size_t queued_ = 0;
  TileMask reachable_;
};

}  // namespace penumbra::labelling
