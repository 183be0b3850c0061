// SPDX-License-Identifier: Apache-2.0
// What the classifier and its kernels, SIMD and scalar, share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra::labelling {

inline constexpr float metres_per_millimetre = 0.001f;

[[nodiscard]] inline float metres(float depth) { return depth; }
[[nodiscard]] inline float metres(std::uint16_t depth) {
  return static_cast<float>(depth) * metres_per_millimetre;
}

/// Measurements lie in [near, far], metres; near is not 0 and far is finite.
struct MeasuredRange {
  float near, far;
};

/// A LabelRule as the kernels take it. All arithmetic is float32, products and sums each rounded.
struct Rule {
  explicit Rule(const LabelRule& rule);

  float a, b, c;
  float beyond_factor;  ///< infinite where beyond is folded
  MeasuredRange metres;
  /// The same for depths converted as load_metres does: millimetres * metres_per_millimetre is not
  /// always the float nearest to the depth, as 3.0 m at the end of a range is.
  MeasuredRange millimetres;
  int width;  ///< front_min_width
  int cells;  ///< how many cells the edge margin reaches; 0: no margin
  int reach;  ///< how far from a seed a front pixel is confirmed

  [[nodiscard]] bool cleans_up() const { return width > 0; }
};

/// One bit per pixel: bit u % 64 of row(v)[u / 64]. `margin` rows of zeros lie above and below and
/// words of zeros beside each row, so that neighbours may be read without asking where they are.
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
  static constexpr std::ptrdiff_t spare = 8;  // words that whole vectors may run over
  std::ptrdiff_t pitch_;
  std::vector<std::uint64_t> bits_;
};

/// The nearest virtual depth of each cell of LabelRule::cell pixels squared, infinite where it
/// holds no robot; with a rim of such cells, so that neighbours may be read unasked.
class Cells {
 public:
  Cells(int width, int height, int reach);

  [[nodiscard]] float* row(int j) { return depth_.data() + (j + reach_) * pitch_ + reach_; }
  void clear(int u0, int u1, int v0, int v1);  ///< the cells of pixels [u0, u1) x [v0, v1)

 private:
  static constexpr int spare = 16;  // cells that whole vectors may run over
  int reach_;
  std::ptrdiff_t pitch_;
  std::vector<float> depth_;
};

using Counts = std::array<std::size_t, label_count>;  ///< clear is left 0

/// The buffers of one classifier.
struct Work {
  Work(int width, int height, const Rule& rule);

  /// Takes the touched tiles of a new image and clears what the last one left.
  void begin(const TileMask& new_touched);

  /// Fills rim_tiles: those beside front_tiles that hold pixels whose being certain decides about a
  /// front pixel.
  void mark_rim();

  /// The touched tiles whose cells decide which pixels of `tiles` are certain and that were not
  /// marked before.
  const TileMask& mark_cells(const TileMask& tiles);

  Rule rule;
  int width;
  int height;
  Image<std::uint8_t> labels;
  TileMask touched;  ///< tiles of `labels` that may hold other than clear

  // Of the clean-up, which looks at tiles near front pixels alone.
  TileMask front_tiles;    ///< tiles that hold bits of `front`
  TileMask certain_tiles;  ///< tiles that hold pixels both front and certain
  TileMask rim_tiles;
  BitRows front, certain, unmeasured, scratch;
  Cells cells;

  std::vector<float> nearest, limits;  ///< one row of pixels each, with room for whole vectors
  Image<std::uint8_t> marks;           ///< the scalar twin's, which has no use for bit rows

 private:
  TileMask cell_tiles_;  // tiles whose cells are filled
  TileMask scratch_tiles_;
};

/// The tiles of tile row j that hold pixels at most `pixels` from a marked tile in u and v.
[[nodiscard]] std::uint64_t marked_around(const TileMask& tiles, std::size_t j, int pixels);

[[nodiscard]] inline bool any(const TileMask& tiles) {
  std::uint64_t bits = 0;
  for (const std::uint64_t row : tiles.rows) bits |= row;
  return bits != 0;
}

/// Labels the touched tiles of one image and cleans up, after Work::begin.
struct Kernels {
  Counts (*label_millimetres)(Work&, ImageView<const float> virtual_depth,
                              ImageView<const std::uint16_t> measured);
  Counts (*label_metres)(Work&, ImageView<const float> virtual_depth,
                         ImageView<const float> measured);

  Counts label(Work& work, ImageView<const float> virtual_depth,
               ImageView<const std::uint16_t> measured) const {
    return label_millimetres(work, virtual_depth, measured);
  }
  Counts label(Work& work, ImageView<const float> virtual_depth,
               ImageView<const float> measured) const {
    return label_metres(work, virtual_depth, measured);
  }
};

/// Kernels for a SIMD target (a bit of simd_target).
[[nodiscard]] Kernels simd_kernels(std::int64_t target);

/// The plain twin, which follows LabelRule's words and not the SIMD kernels' ways.
[[nodiscard]] Kernels scalar_kernels();

}  // namespace penumbra::labelling
