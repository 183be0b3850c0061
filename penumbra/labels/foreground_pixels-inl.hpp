// SPDX-License-Identifier: Apache-2.0
// Compiled per SIMD target: the foreground near front pixels.
#if defined(PENUMBRA_FOREGROUND_PIXELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_FOREGROUND_PIXELS_INL
#undef PENUMBRA_FOREGROUND_PIXELS_INL
#else
#define PENUMBRA_FOREGROUND_PIXELS_INL
#endif

#include <algorithm>
#include <array>
#include <limits>

#include <penumbra/labels/label_vectors-inl.hpp>
#include <penumbra/labels/label_work-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {

/// Finds the nearest virtual depth in each column of a block, infinite without robot; at least one
/// whole tile's width.
HWY_INLINE void nearest_of_columns(ImageView<const float> block, float* nearest) {
  const VF far = hn::Set(F(), std::numeric_limits<float>::infinity());
  int u = 0;
  for (; u + lanes <= block.width; u += lanes) {
    VF least = far;
    for (int v = 0; v < block.height; ++v) {
      const VF z = hn::LoadU(F(), block.row(v) + u);
      least = hn::Min(least, hn::IfThenElse(hn::Gt(z, hn::Zero(F())), z, far));
    }
    hn::StoreU(least, F(), nearest + u);
  }
  for (; u < block.width; ++u) {
    nearest[u] = std::numeric_limits<float>::infinity();
    for (int v = 0; v < block.height; ++v)
      if (block(u, v) > 0.0f) nearest[u] = std::min(nearest[u], block(u, v));
  }
  std::fill_n(nearest + u, chunk, std::numeric_limits<float>::infinity());
}

/// Fills the cells of some tiles.
inline void fill_cells(Work& work, const TileMask& tiles, ImageView<const float> virtual_depth) {
  tiles.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int v = v0; v < v1; v += LabelRule::cell) {
      const ImageView<const float> block{virtual_depth.row(v) + u0, u1 - u0,
                                         std::min(LabelRule::cell, v1 - v), virtual_depth.stride};
      float* const columns = work.nearest.data();
      nearest_of_columns(block, columns);
      float* const cells = work.cells.row(v / LabelRule::cell) + u0 / LabelRule::cell;
      static_assert(LabelRule::cell == 4);
      for (int i = 0; i < block.width; i += chunk) {  // writes no cell of the next tile
        VF p, q, r, s;
        hn::LoadInterleaved4(F(), columns + i, p, q, r, s);
        hn::StoreU(hn::Min(hn::Min(p, q), hn::Min(r, s)), F(), cells + i / 4);
      }
    }
  });
}

/// Sets, for the pixels [u0, u1) of a row of cells, work.limits[u] = n - e(n), n the nearest
/// virtual depth of the cells around; 0 without robot.
inline void fill_limits(Work& work, const Criteria& rule, int cell_row, int u0, int u1) {
  const int reach = work.rule.cells;
  const int first = u0 / LabelRule::cell;
  const int last = (u1 + LabelRule::cell - 1) / LabelRule::cell;
  const VF far = hn::Set(F(), std::numeric_limits<float>::infinity());
  float* const columns = work.nearest.data() + reach;
  for (int i = first - reach; i < last + reach; i += lanes) {
    VF nearest = far;
    for (int j = cell_row - reach; j <= cell_row + reach; ++j)
      nearest = hn::Min(nearest, hn::LoadU(F(), work.cells.row(j) + i));
    hn::StoreU(nearest, F(), columns + i);
  }
  for (int i = first; i < last; i += lanes) {
    VF nearest = far;
    for (int k = -reach; k <= reach; ++k)
      nearest = hn::Min(nearest, hn::LoadU(F(), columns + i + k));
    const VF limit =
        hn::IfThenElseZero(hn::Lt(nearest, far), hn::Sub(nearest, rule.tolerance(nearest)));
    static_assert(LabelRule::cell == 4);
    hn::StoreInterleaved4(limit, limit, limit, limit, F(), work.limits.data() + 4 * i);
  }
}

/// One bit per pixel.
struct ForegroundBits {
  std::uint32_t foreground = 0, unmeasured = 0;
};

constexpr int bits_width = 32;  // pixels of ForegroundBits; divides a tile

template <typename T>
HWY_INLINE ForegroundBits foreground_bits(const Criteria& rule, const T* measured,
                                          const float* limits) {
  const auto bits_of = [](hn::Mask<F> mask) HWY_ATTR {
    std::uint8_t bytes[8];  // Highway may write all of them
    hn::StoreMaskBits(F(), mask, bytes);
    return static_cast<std::uint32_t>(bytes[0]);
  };
  ForegroundBits bits;
#pragma GCC unroll 4
  for (int i = 0; i < bits_width; i += lanes) {
    const VF d = load_metres(measured + i);
    const auto seen = hn::RebindMask(F(), rule.measured(d));
    bits.foreground |= bits_of(hn::And(seen, hn::Lt(d, hn::LoadU(F(), limits + i)))) << i;
    bits.unmeasured |= bits_of(hn::Not(seen)) << i;
  }
  return bits;
}

/// Fills the bit rows `foreground` and `unmeasured` of some tiles and adds to foreground_tiles.
template <typename T>
void find_foreground(Work& work, const TileMask& tiles, ImageView<const float> virtual_depth,
                     ImageView<const T> measured) {
  const bool has_margin = work.rule.cells > 0;
  if (has_margin) fill_cells(work, work.mark_cells(tiles), virtual_depth);
  const Criteria rule(work.rule, measured.data);
  const auto find = [&](const T* d, int u, int v) HWY_ATTR {
    ForegroundBits bits = foreground_bits(rule, d, work.limits.data() + u);
    const std::uint32_t front = work.front.get(u, v);
    if (!has_margin) bits.foreground = front;
    work.foreground.put(u, v, bits.foreground);
    work.unmeasured.put(u, v, bits.unmeasured);
    if ((front & bits.foreground) != 0) work.foreground_tiles.mark(u, v, u, v);
  };
  tiles.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int v = v0; v < v1; ++v) {
      if (has_margin && v % LabelRule::cell == 0)
        fill_limits(work, rule, v / LabelRule::cell, u0, u1);
      const T* const row = measured.row(v);
      const T* const next = measured.row(std::min(v + TileMask::tile_height, measured.height - 1));
      int u = u0;
      for (; u + bits_width <= u1; u += bits_width) {
        hwy::Prefetch(next + u);
        find(row + u, u, v);
      }
      if (u == u1) continue;
      std::array<T, bits_width> cut{};  // 0 outside of the image
      std::copy(row + u, row + u1, cut.begin());
      find(cut.data(), u, v);
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#endif
