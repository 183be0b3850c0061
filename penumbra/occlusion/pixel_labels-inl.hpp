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
using B = hn::CappedTag<std::uint8_t, 32>;
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

/// One bit per pixel of a chunk.
struct ChunkBits {
  std::uint32_t robot = 0, measured = 0, front = 0, beyond = 0, certain = 0;

  [[nodiscard]] std::uint32_t unknown() const { return robot & ~measured; }
  [[nodiscard]] std::uint32_t occluded() const { return robot & measured & ~front & ~beyond; }
};

/// Compares a chunk. `limit`: below it a measured depth is certain.
template <bool with_certain, typename T>
HWY_INLINE ChunkBits compare_chunk(const Rule& rule, const float* HWY_RESTRICT virtual_depth,
                                   const T* HWY_RESTRICT measured,
                                   const float* HWY_RESTRICT limit) {
  ChunkBits bits;
#pragma GCC unroll 4
  for (int i = 0; i < chunk; i += lanes()) {
    const VF z = hn::LoadU(F(), virtual_depth + i);
    const VF d = load_metres(measured + i);
    const VF e = tolerance(rule, z);
    const VF past = hn::Add(z, hn::Mul(hn::Set(F(), rule.beyond_factor), e));
    const auto real =
        hn::And(hn::Ge(d, hn::Set(F(), rule.near)), hn::Le(d, hn::Set(F(), rule.far)));
    bits.robot |= bits_of(hn::Gt(z, hn::Zero(F()))) << i;
    bits.measured |= bits_of(real) << i;
    bits.front |= bits_of(hn::Lt(d, hn::Sub(z, e))) << i;
    bits.beyond |= bits_of(hn::Gt(d, past)) << i;
    if constexpr (with_certain) bits.certain |= bits_of(hn::Lt(d, hn::LoadU(F(), limit + i))) << i;
  }
  bits.front &= bits.robot & bits.measured;
  bits.beyond &= bits.robot & bits.measured;
  bits.certain &= bits.measured;
  return bits;
}

/// Writes a chunk's labels: each value's bits, spread to bytes.
HWY_INLINE void write_labels(const ChunkBits& bits, std::uint8_t* HWY_RESTRICT labels) {
  static_assert(static_cast<int>(Label::front) == 1 && static_cast<int>(Label::occluded) == 2 &&
                static_cast<int>(Label::unknown) == 3 && static_cast<int>(Label::beyond) == 4);
  const std::uint32_t bit0 = bits.front | bits.unknown();
  const std::uint32_t bit1 = bits.occluded() | bits.unknown();
  const B d;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < chunk; i += step) {
    const auto spread = [&](std::uint32_t plane, int value) HWY_ATTR {
      std::uint8_t bytes[8] = {};  // LoadMaskBits may read eight
      plane >>= i;
      std::memcpy(bytes, &plane, sizeof plane);
      return hn::IfThenElseZero(hn::LoadMaskBits(d, bytes),
                                hn::Set(d, static_cast<std::uint8_t>(value)));
    };
    hn::StoreU(hn::Or(hn::Or(spread(bit0, 1), spread(bit1, 2)), spread(bits.beyond, 4)), d,
               labels + i);
  }
}

template <bool with_certain, typename T>
HWY_INLINE ChunkBits label_chunk(const Rule& rule, const float* HWY_RESTRICT virtual_depth,
                                 const T* HWY_RESTRICT measured, const float* HWY_RESTRICT limit,
                                 std::uint8_t* HWY_RESTRICT labels) {
  const ChunkBits bits = compare_chunk<with_certain>(rule, virtual_depth, measured, limit);
  write_labels(bits, labels);
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
  if (bits.front == 0) return;
  const auto tile_row = static_cast<std::size_t>(v / TileMask::tile_height);
  const int tile = u / work.touched.tile_width;
  work.front_tiles.rows[tile_row] |= std::uint64_t{1} << tile;
  work.certain_tiles.rows[tile_row] |= std::uint64_t{(bits.front & bits.certain) != 0} << tile;
}

HWY_INLINE void count(const ChunkBits& bits, Counts& counts) {
  const auto add = [&](Label label, std::uint32_t pixels) {
    counts[static_cast<std::size_t>(label)] += static_cast<std::size_t>(std::popcount(pixels));
  };
  add(Label::front, bits.front);
  add(Label::unknown, bits.unknown());
  add(Label::beyond, bits.beyond);
  add(Label::occluded, bits.occluded());
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
  const Rule rule = work.rule;              // copies, which no store to a label can change
  const bool own_limits = rule.cells == 0;  // then the front pixels are the certain ones
  const ImageView<std::uint8_t> labels = work.labels.view();
  const float* const limits = work.limits.data();
  Counts sum{};
  const auto label_span = [=, &work, &sum](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int v = v0; v < v1; ++v) {
      if (with_certain && !own_limits && v % LabelRule::cell == 0)
        fill_limits(work, v / LabelRule::cell, u0, u1);
      const float* const z = virtual_depth.row(v);
      const T* const d = measured.row(v);
      std::uint8_t* const out = labels.row(v);
      for (int u = u0; u < u1; u += chunk) {
        ChunkBits bits =
            u + chunk <= u1
                ? label_chunk<with_certain>(rule, z + u, d + u, limits + u, out + u)
                : label_cut_chunk<with_certain>(rule, u1 - u, z + u, d + u, limits + u, out + u);
        if (with_certain && own_limits) bits.certain = bits.front;
        if constexpr (with_certain) keep_bits(work, u, v, bits);
        count(bits, sum);
      }
    }
  };
  tiles.for_each_span(label_span);
  for (std::size_t i = 0; i < sum.size(); ++i) counts[i] += sum[i];
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
