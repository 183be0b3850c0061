// SPDX-License-Identifier: Apache-2.0
// Compiled per SIMD target: the labels of single pixels, and which pixels are certain.
#if defined(PENUMBRA_PIXEL_LABELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_PIXEL_LABELS_INL
#undef PENUMBRA_PIXEL_LABELS_INL
#else
#define PENUMBRA_PIXEL_LABELS_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include <hwy/highway.h>

#include <penumbra/occlusion/label_work-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

constexpr int chunk = 32;  // pixels that are labelled at once; a tile is whole chunks wide

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(F())); }

HWY_INLINE VF load_metres(const float* depth) { return hn::LoadU(F(), depth); }

HWY_INLINE VF load_metres(const std::uint16_t* depth) {
  const hn::Rebind<std::uint16_t, F> narrow;
  const VI millimetres = hn::PromoteTo(I(), hn::LoadU(narrow, depth));
  return hn::Mul(hn::ConvertTo(F(), millimetres), hn::Set(F(), metres_per_millimetre));
}

HWY_INLINE VF tolerance(const Rule& rule, VF z) {
  const VF slope = hn::Add(hn::Set(F(), rule.b), hn::Mul(hn::Set(F(), rule.c), z));
  return hn::Add(hn::Set(F(), rule.a), hn::Mul(slope, z));
}

HWY_INLINE std::uint32_t bits_of(hn::Mask<F> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(F(), mask, bytes);
  if (hn::Lanes(F()) <= 8) return bytes[0];
  std::uint16_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

HWY_INLINE VI ones(hn::Mask<F> mask) { return hn::VecFromMask(I(), hn::RebindMask(I(), mask)); }

/// One bit per pixel of a chunk.
struct ChunkBits {
  std::uint32_t robot = 0, measured = 0, front = 0, beyond = 0, certain = 0;
};

/// Labels a chunk. `limit`: below it a measured depth is certain.
template <bool with_certain, typename T>
HWY_INLINE ChunkBits label_chunk(const Rule& rule, const float* HWY_RESTRICT virtual_depth,
                                 const T* HWY_RESTRICT measured, const float* HWY_RESTRICT limit,
                                 std::uint8_t* HWY_RESTRICT labels) {
  const hn::Rebind<std::uint8_t, F> bytes;
  const auto value = [](Label label) HWY_ATTR { return hn::Set(I(), static_cast<int>(label)); };
  const auto where = [](hn::Mask<F> mask) HWY_ATTR { return hn::RebindMask(I(), mask); };
  ChunkBits bits;
  for (int i = 0; i < chunk; i += lanes()) {
    const VF z = hn::LoadU(F(), virtual_depth + i);
    const VF d = load_metres(measured + i);
    const VF e = tolerance(rule, z);
    const auto robot = hn::Gt(z, hn::Zero(F()));
    const auto in_range =
        hn::And(hn::Ge(d, hn::Set(F(), rule.near)), hn::Le(d, hn::Set(F(), rule.far)));
    const auto real = hn::And(hn::Gt(d, hn::Zero(F())), in_range);
    const auto compared = hn::And(robot, real);
    const VF past = hn::Add(z, hn::Mul(hn::Set(F(), rule.beyond_factor), e));
    const auto front = hn::And(compared, hn::Lt(d, hn::Sub(z, e)));
    const auto beyond = hn::And(compared, hn::Gt(d, past));
    VI label = hn::IfThenElse(where(real), value(Label::occluded), value(Label::unknown));
    label = hn::IfThenElse(where(front), value(Label::front), label);
    label = hn::IfThenElse(where(beyond), value(Label::beyond), label);
    label = hn::IfThenElseZero(where(robot), label);
    hn::StoreU(hn::DemoteTo(bytes, label), bytes, labels + i);
    bits.robot |= bits_of(robot) << i;
    bits.measured |= bits_of(real) << i;
    bits.front |= bits_of(front) << i;
    bits.beyond |= bits_of(beyond) << i;
    if constexpr (with_certain)
      bits.certain |= bits_of(hn::And(real, hn::Lt(d, hn::LoadU(F(), limit + i)))) << i;
  }
  return bits;
}

/// A chunk that the image cuts off after `count` pixels.
template <bool with_certain, typename T>
HWY_NOINLINE ChunkBits label_cut_chunk(const Rule& rule, int count, const float* virtual_depth,
                                       const T* measured, const float* limit,
                                       std::uint8_t* labels) {
  std::array<float, chunk> z{};
  std::array<T, chunk> d{};
  std::array<std::uint8_t, chunk> out;
  std::copy_n(virtual_depth, count, z.begin());
  std::copy_n(measured, count, d.begin());
  const ChunkBits bits = label_chunk<with_certain>(rule, z.data(), d.data(), limit, out.data());
  std::copy_n(out.begin(), count, labels);
  return bits;
}

/// Adds a chunk's bits to the bit rows and its tile to the tile masks.
HWY_INLINE void keep_bits(Work& work, int u, int v, const ChunkBits& bits) {
  const auto put = [&](BitRows& rows, std::uint32_t value) {
    std::memcpy(reinterpret_cast<std::uint32_t*>(rows.row(v)) + u / chunk, &value, sizeof value);
  };
  put(work.front, bits.front);
  put(work.certain, bits.certain);
  put(work.unmeasured, ~bits.measured);
  const auto tile_row = static_cast<std::size_t>(v / TileMask::tile_height);
  const int tile = u / work.touched.tile_width;
  work.front_tiles.rows[tile_row] |= std::uint64_t{bits.front != 0} << tile;
  work.certain_tiles.rows[tile_row] |= std::uint64_t{(bits.front & bits.certain) != 0} << tile;
}

HWY_INLINE void count(const ChunkBits& bits, Counts& counts) {
  const auto add = [&](Label label, std::uint32_t pixels) {
    counts[static_cast<std::size_t>(label)] += static_cast<std::size_t>(std::popcount(pixels));
  };
  add(Label::front, bits.front);
  add(Label::unknown, bits.robot & ~bits.measured);
  add(Label::beyond, bits.beyond);
  add(Label::occluded, bits.robot & bits.measured & ~bits.front & ~bits.beyond);
}

/// For the pixels [u0, u1) of a row of cells: work.limits[u] = n - e(n), n the nearest virtual
/// depth of the cells around; 0 where there is none.
inline void fill_limits(Work& work, int cell_row, int u0, int u1) {
  const int reach = work.rule.cells;
  const int first = u0 / LabelRule::cell;
  const int last = (u1 + LabelRule::cell - 1) / LabelRule::cell;
  const VF far = hn::Set(F(), std::numeric_limits<float>::infinity());
  float* const columns = work.nearest.data() + reach;
  for (int i = first - reach; i < last + reach; i += lanes()) {
    VF nearest = far;
    for (int j = cell_row - reach; j <= cell_row + reach; ++j)
      nearest = hn::Min(nearest, hn::LoadU(F(), work.cells.row(j) + i));
    hn::StoreU(nearest, F(), columns + i);
  }
  for (int i = first; i < last; i += lanes()) {
    VF nearest = far;
    for (int k = -reach; k <= reach; ++k)
      nearest = hn::Min(nearest, hn::LoadU(F(), columns + i + k));
    const VF limit =
        hn::IfThenElseZero(hn::Lt(nearest, far), hn::Sub(nearest, tolerance(work.rule, nearest)));
    static_assert(LabelRule::cell == 4);
    hn::StoreInterleaved4(limit, limit, limit, limit, F(), work.limits.data() + 4 * i);
  }
}

/// Labels the pixels of some tiles. Where there is no robot this finds the certain pixels alone.
template <bool with_certain, typename T>
void label_tiles(Work& work, const TileMask& tiles, ImageView<const float> virtual_depth,
                 ImageView<const T> measured, Counts& counts) {
  const bool own_limits = work.rule.cells == 0;  // then the front pixels are the certain ones
  const float* const limits = work.limits.data();
  tiles.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int v = v0; v < v1; ++v) {
      if (with_certain && !own_limits && v % LabelRule::cell == 0)
        fill_limits(work, v / LabelRule::cell, u0, u1);
      for (int u = u0; u < u1; u += chunk) {
        const float* const z = virtual_depth.row(v) + u;
        const T* const d = measured.row(v) + u;
        std::uint8_t* const labels = work.labels.view().row(v) + u;
        ChunkBits bits =
            u + chunk <= u1
                ? label_chunk<with_certain>(work.rule, z, d, limits + u, labels)
                : label_cut_chunk<with_certain>(work.rule, u1 - u, z, d, limits + u, labels);
        if (with_certain && own_limits) bits.certain = bits.front;
        if constexpr (with_certain) keep_bits(work, u, v, bits);
        count(bits, counts);
      }
    }
  });
}

/// Nearest virtual depth of `count` pixels in each column of `rows` rows, into `nearest`; infinite
/// where there is no robot, and up to the next four whole vectors.
HWY_INLINE void nearest_of_columns(ImageView<const float> block, float* nearest) {
  const VF far = hn::Set(F(), std::numeric_limits<float>::infinity());
  int u = 0;
  for (; u + lanes() <= block.width; u += lanes()) {
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
  std::fill_n(nearest + u, 4 * lanes(), std::numeric_limits<float>::infinity());
}

/// Fills the cells of the touched tiles. Cells to the right of a span are made empty on the way,
/// which is what they are or are not yet filled.
inline void fill_cells(Work& work, ImageView<const float> virtual_depth) {
  work.touched.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int v = v0; v < v1; v += LabelRule::cell) {
      const ImageView<const float> block{virtual_depth.row(v) + u0, u1 - u0,
                                         std::min(LabelRule::cell, v1 - v), virtual_depth.stride};
      float* const columns = work.nearest.data();
      nearest_of_columns(block, columns);
      float* const cells = work.cells.row(v / LabelRule::cell) + u0 / LabelRule::cell;
      for (int i = 0; i < block.width; i += 4 * lanes()) {
        VF p, q, r, s;
        hn::LoadInterleaved4(F(), columns + i, p, q, r, s);
        hn::StoreU(hn::Min(hn::Min(p, q), hn::Min(r, s)), F(), cells + i / 4);
      }
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#endif
