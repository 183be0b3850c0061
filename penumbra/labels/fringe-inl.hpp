// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/labels/label_work-inl.hpp>

namespace penumbra::labelling {

inline constexpr float millimetres_per_metre = 1000.0f;

/// The buffers of the flood fill that finds the fringe (LabelRule), over blocks of 2 x 2 pixels.
struct Fringe {
  static constexpr std::uint16_t farthest = 0x7ffe;  ///< millimetres; a robot farther has no fringe
  static constexpr std::uint16_t unfilled = 0xffff;  ///< a block whose tile is not filled yet

  Fringe(int width, int height, int reach_pixels);

  /// A block on the robot's outline. The flood from it continues to depths in [nearest, farthest]
  /// that differ from their neighbour's by at most `step`, millimetres.
  struct Source {
    std::uint16_t nearest, farthest, step;
    std::int16_t x, y;
  };

  /// Packed into one number, so that one sum gives a neighbour with the same source.
  struct Block {
    std::uint64_t bits;

    Block() = default;
    Block(int x, int y, std::size_t source)
        : bits(static_cast<std::uint64_t>(x) | static_cast<std::uint64_t>(y) << 16 | source << 32) {
    }
    [[nodiscard]] int x() const { return static_cast<std::uint16_t>(bits); }
    [[nodiscard]] int y() const { return static_cast<std::uint16_t>(bits >> 16); }
    [[nodiscard]] std::size_t source() const { return bits >> 32; }  ///< index in sources
  };

  [[nodiscard]] std::uint16_t* block(int x, int y) {
    return &blocks[static_cast<std::size_t>(y + 1) * pitch + static_cast<std::size_t>(x + 1)];
  }
  /// Makes all blocks of the last image unfilled, and marks the tiles at most `pixels` from the
  /// touched ones, for the caller to fill.
  void begin(const TileMask& touched, int pixels);
  void add_source(const Rule& rule, int x, int y, std::uint16_t depth);

  int reach;  ///< pixels; 0: no fringe
  std::size_t pitch;
  /// In the tiles that are filled, with a border of zeros around the image: the nearest depth of
  /// the occluded pixels of each block, in millimetres; without any, that of its clear pixels, with
  /// the bit is_open until the flood reaches it; without any, 0.
  std::vector<std::uint16_t> blocks;
  std::vector<Source> sources;
  std::unique_ptr<Block[]> queue;  ///< the sources' blocks, then those that the flood reached
  TileMask filled;
  std::vector<std::uint16_t> nothing_known;  ///< a row of SceneMemory::none
};

/// Labels the fringe in a labelled image and marks its tiles as touched. `known`: of
/// Classifier::classify(). Returns the number of its pixels.
using LabelFringe = std::size_t (*)(Fringe&, Work&, const DepthView& measured,
                                    ImageView<const std::uint16_t> known);

/// Returns the kernel for a SIMD target (a bit of simd_target).
[[nodiscard]] LabelFringe fringe_kernel(std::int64_t target);

}  // namespace penumbra::labelling
