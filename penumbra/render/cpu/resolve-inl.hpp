// SPDX-License-Identifier: Apache-2.0
// From packed inverse depth to the depth and link images.
#if defined(PENUMBRA_RENDER_CPU_RESOLVE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_RENDER_CPU_RESOLVE_INL
#undef PENUMBRA_RENDER_CPU_RESOLVE_INL
#else
#define PENUMBRA_RENDER_CPU_RESOLVE_INL
#endif

#include <bit>
#include <span>
#include <utility>

#include <penumbra/render/cpu/kernel.hpp>
#include <penumbra/render/cpu/simd-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

/// Stores two neighbouring blocks' values in their rows of an image.
template <typename T, typename Store>
HWY_INLINE void StoreRows(VF left, VF right, T* image, std::size_t stride, Store store) {
  if constexpr (kBlockHeight == 4) {
    // Pixel rows of both blocks side by side: 0 and 1, 2 and 3.
    const hn::Half<DF> half;
    const auto low = hn::ConcatLowerLower(df, right, left);
    const auto high = hn::ConcatUpperUpper(df, right, left);
    HWY_ALIGN static constexpr std::int32_t kOrder[16] = {0, 1, 2, 3, 8,  9,  10, 11,
                                                          4, 5, 6, 7, 12, 13, 14, 15};
    const auto order = hn::SetTableIndices(df, kOrder);
    const auto rows01 = hn::TableLookupLanes(low, order);
    const auto rows23 = hn::TableLookupLanes(high, order);
    store(half, hn::LowerHalf(half, rows01), image);
    store(half, hn::UpperHalf(half, rows01), image + stride);
    store(half, hn::LowerHalf(half, rows23), image + 2 * stride);
    store(half, hn::UpperHalf(half, rows23), image + 3 * stride);
  } else if constexpr (kBlockHeight == 2) {
    store(df, hn::ConcatLowerLower(df, right, left), image);
    store(df, hn::ConcatUpperUpper(df, right, left), image + stride);
  } else {
    store(df, left, image);
    store(df, right, image + block_width);
  }
}

/// A tile of the image: its first pixel, and blocks in its rows (an even number).
struct Tile {
  std::size_t u, v, blocks;

  [[nodiscard]] std::size_t offset(const Canvas& canvas, std::size_t block_row) const {
    return (v / kBlockHeight + block_row) * canvas.lanes_per_row + u / block_width * kStep;
  }
};
constexpr std::size_t kTileBlockRows = TileMask::tile_height / kBlockHeight;

/// Whether nothing was drawn in the tile.
HWY_INLINE bool IsEmpty(std::span<const Canvas> canvases, const Tile& tile) {
  auto any = hn::Zero(di);
  for (const Canvas& canvas : canvases) {
    for (std::size_t row = 0; row < kTileBlockRows; ++row) {
      const std::int32_t* block = canvas.packed.data() + tile.offset(canvas, row);
      for (std::size_t i = 0; i < tile.blocks; ++i) {
        any = hn::Or(any, hn::Load(di, block + i * kStep));
      }
    }
  }
  return hn::AllTrue(di, hn::Eq(any, hn::Zero(di)));
}

/// Takes the nearest of all canvases and empties them.
HWY_INLINE VI TakeBlock(std::int32_t* first, std::span<Canvas> others, std::size_t offset) {
  auto word = hn::Load(di, first + offset);
  hn::Store(hn::Zero(di), di, first + offset);
  for (Canvas& canvas : others) {
    std::int32_t* block = canvas.packed.data() + offset;
    word = hn::Max(word, hn::Load(di, block));
    hn::Store(hn::Zero(di), di, block);
  }
  return word;
}

void ResolveTile(std::span<Canvas> canvases, const Packing& packing, const Tile& tile,
                 const Output& output) {
  const auto id_mask = hn::Set(di, packing.id_mask);
  const auto half_step = hn::Set(di, packing.half_step);
  const auto smallest = hn::BitCast(di, hn::Set(df, 1e-30F));  // 1/m
  std::int32_t* const packed = canvases[0].packed.data();
  const std::span<Canvas> others = canvases.subspan(1);
  const std::size_t stride = output.stride;
  const auto depth_of = [&](VI word) HWY_ATTR {
    // An empty lane's half step would be a denormal, which divides slowly: keep it a normal number.
    const auto bits = hn::Max(hn::Or(hn::AndNot(id_mask, word), half_step), smallest);
    return hn::IfThenElseZero(hn::RebindMask(df, hn::Ne(word, hn::Zero(di))),
                              hn::Div(hn::Set(df, 1.0F), hn::BitCast(df, bits)));
  };
  const auto id_of = [&](VI word) HWY_ATTR { return hn::BitCast(df, hn::And(word, id_mask)); };
  const auto store_depth = [](auto d, auto values, float* to)
                               HWY_ATTR { hn::StoreU(values, d, to); };
  const auto store_id = [](auto d, auto values, std::uint16_t* to) HWY_ATTR {
    const hn::Rebind<std::uint16_t, decltype(d)> narrow;
    const hn::RebindToSigned<decltype(d)> wide;
    hn::StoreU(hn::DemoteTo(narrow, hn::BitCast(wide, values)), narrow, to);
  };
  for (std::size_t row = 0; row < kTileBlockRows; ++row) {
    const std::size_t offset = tile.offset(canvases[0], row);
    const std::size_t first = (tile.v + row * kBlockHeight) * stride + tile.u;
    float* depth = output.depth + first;
    std::uint16_t* links = output.links + first;
    for (std::size_t i = 0; i < tile.blocks; i += 2) {
      const auto left = TakeBlock(packed, others, offset + i * kStep);
      const auto right = TakeBlock(packed, others, offset + (i + 1) * kStep);
      StoreRows(depth_of(left), depth_of(right), depth + i * block_width, stride, store_depth);
      StoreRows(id_of(left), id_of(right), links + i * block_width, stride, store_id);
    }
  }
}

std::uint64_t Resolve(std::span<Canvas> canvases, const Packing& packing, std::uint64_t previous,
                      std::size_t row, const Output& output) {
  std::uint64_t marked = 0;
  for (Canvas& canvas : canvases) marked |= std::exchange(canvas.touched.rows[row], 0);
  const auto width = static_cast<std::size_t>(canvases[0].touched.tile_width);
  std::uint64_t touched = 0;
  for (std::uint64_t bits = marked | previous; bits != 0; bits &= bits - 1) {
    const std::uint64_t bit = bits & (~bits + 1);
    const auto column = static_cast<std::size_t>(std::countr_zero(bits));
    const Tile tile{column * width, row * TileMask::tile_height, width / block_width};
    // Clusters are marked by bounding boxes: many marked tiles stay empty.
    const bool empty = (marked & bit) == 0 || IsEmpty(canvases, tile);
    if (!empty) touched |= bit;
    if (!empty || (previous & bit) != 0) ResolveTile(canvases, packing, tile, output);
  }
  return touched;
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#endif  // PENUMBRA_RENDER_CPU_RESOLVE_INL
