// SPDX-License-Identifier: Apache-2.0
// What the classifier and its kernels share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/labels/rule.hpp>

namespace penumbra::labelling {

/// One bit per pixel: bit u % 64 of row(v)[u / 64]. A border of zeros allows reading neighbours of
/// any pixel: `margin` rows above and below, and words next to each row.
class BitRows {
 public:
  static constexpr int margin = 2 * LabelRule::max_width;

  BitRows(int width, int height)
      : pitch_(left + (width + 63) / 64 + spare),
        bits_(static_cast<std::size_t>(pitch_) * static_cast<std::size_t>(height + 2 * margin)) {}

  [[nodiscard]] std::ptrdiff_t pitch() const { return pitch_; }
  [[nodiscard]] std::uint64_t* row(int v) { return bits_.data() + (v + margin) * pitch_ + left; }
  /// The 32 pixels that begin at (u, v), u a multiple of 32.
  [[nodiscard]] std::uint32_t get(int u, int v) {
    std::uint32_t value;
    std::memcpy(&value, reinterpret_cast<const unsigned char*>(row(v)) + u / 8, sizeof value);
    return value;
  }
  void put(int u, int v, std::uint32_t value) {
    std::memcpy(reinterpret_cast<unsigned char*>(row(v)) + u / 8, &value, sizeof value);
  }
  void clear(int u0, int u1, int v0, int v1);  ///< pixels [u0, u1) x [v0, v1), 32 at a time

 private:
  static constexpr std::ptrdiff_t left = 2;
  static constexpr std::ptrdiff_t spare = 8;  // words, for whole vectors
  std::ptrdiff_t pitch_;
  std::vector<std::uint64_t> bits_;
};

/// The nearest virtual depth of each cell of LabelRule::cell pixels squared, infinite without
/// robot, with a border of such cells.
class Cells {
 public:
  Cells(int width, int height, int reach);

  [[nodiscard]] float* row(int j) { return depth_.data() + (j + reach_) * pitch_ + reach_; }
  void clear(int u0, int u1, int v0, int v1);  ///< the cells of pixels [u0, u1) x [v0, v1)

 private:
  static constexpr int spare = 16;  // cells, for whole vectors
  int reach_;
  std::ptrdiff_t pitch_;
  std::vector<float> depth_;
};

using Counts = std::array<std::size_t, label_count>;  ///< clear is always 0

/// The buffers of one classifier.
struct Work {
  Work(int width, int height, const Rule& rule);

  /// Sets the touched tiles of a new image and clears the buffers of the last one.
  void begin(const TileMask& new_touched);

  /// Fills rim_tiles: tiles without front pixels whose foreground decides about front pixels.
  void mark_rim();

  /// Returns the touched tiles whose cells decide which pixels of `tiles` are foreground, except
  /// those of earlier calls.
  const TileMask& mark_cells(const TileMask& tiles);

  Rule rule;
  int width;
  int height;
  Image<std::uint8_t> labels;
  TileMask touched;  ///< outside of these tiles `labels` is clear

  // The clean-up processes only tiles near front pixels.
  TileMask front_tiles;       ///< tiles with bits of `front`
  TileMask foreground_tiles;  ///< tiles with pixels that are both front and foreground
  TileMask rim_tiles;
  BitRows front, foreground, unmeasured, scratch;
  Cells cells;

  std::vector<float> nearest, limits;  ///< one row of pixels each, for whole vectors

 private:
  TileMask cell_tiles_;  // tiles with filled cells
  TileMask scratch_tiles_;
};

/// Returns the tiles of tile row j with pixels at most `pixels` from a marked tile in u and v.
[[nodiscard]] std::uint64_t marked_around(const TileMask& tiles, std::size_t j, int pixels);

[[nodiscard]] inline bool any(const TileMask& tiles) {
  std::uint64_t bits = 0;
  for (const std::uint64_t row : tiles.rows) bits |= row;
  return bits != 0;
}

/// Labels the touched tiles of one image and cleans up, after Work::begin.
using LabelKernel = Counts (*)(Work&, ImageView<const float> virtual_depth,
                               const DepthView& measured);

/// Returns the kernel for a SIMD target (a bit of simd_target).
[[nodiscard]] LabelKernel label_kernel(std::int64_t target);

}  // namespace penumbra::labelling
