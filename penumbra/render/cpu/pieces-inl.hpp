// SPDX-License-Identifier: Apache-2.0
// Large triangles, cut into runs of blocks.
#if defined(PENUMBRA_RENDER_CPU_PIECES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_RENDER_CPU_PIECES_INL
#undef PENUMBRA_RENDER_CPU_PIECES_INL
#else
#define PENUMBRA_RENDER_CPU_PIECES_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include <penumbra/render/cpu/fill-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

/// An edge function solved for u along pixel rows: inside are low(v) <= u <= high(v), one of which
/// does not bound. Rounding stays below the edge function's bias; 0.01 pixel more only costs
/// blocks.
struct EdgeLine {
  VF low_base, low_slope, high_base, high_slope;

  EdgeLine(float value, float slope_u, float slope_v) {
    constexpr float flat = 1e-30F;  // an edge along the row: all of it, or none
    constexpr float far = 1e9F;
    constexpr float margin = 0.01F;
    const float divisor = std::abs(slope_u) < flat ? flat : slope_u;
    const float base = -value / divisor;
    const float slope = -slope_v / divisor;
    low_base = hn::Set(df, divisor > 0 ? base - margin : -far);
    low_slope = hn::Set(df, divisor > 0 ? slope : 0.0F);
    high_base = hn::Set(df, divisor > 0 ? far : base + margin);
    high_slope = hn::Set(df, divisor > 0 ? 0.0F : slope);
  }
  [[nodiscard]] HWY_INLINE VF low(VF v) const { return hn::MulAdd(v, low_slope, low_base); }
  [[nodiscard]] HWY_INLINE VF high(VF v) const { return hn::MulAdd(v, high_slope, high_base); }
};

/// What is constant while a large triangle is cut into runs.
struct LargeTriangle {
  EdgeLine a, b, c;
  VF end;  // pixels from its first column
  VI offset, height;

  explicit LargeTriangle(const Record& r)
      : a(r.base.edge0, r.du.edge0, r.dv.edge0),
        b(r.base.edge1, r.du.edge1, r.dv.edge1),
        c(r.base.edge2, r.du.edge2, r.dv.edge2),
        end(hn::Set(df, static_cast<float>(r.width * block_width))),
        offset(hn::Set(di, static_cast<std::int32_t>(r.offset))),
        height(hn::Set(di, r.height)) {}
};

/// Adds a run of blocks of any length.
void AddPiece(Scratch& s, Piece piece, std::int32_t blocks) {
  while (blocks > 0) {
    const std::int32_t length = std::min(blocks, static_cast<std::int32_t>(Scratch::longest_piece));
    s.pieces[static_cast<std::size_t>(length) - 1].push(piece);
    piece.offset += length * kLanes;
    piece.du += static_cast<float>(length * block_width);
    blocks -= length;
  }
}

/// Up to kLanes block rows of a large triangle: where its run of blocks begins in each, and how
/// many blocks it has.
struct Runs {
  VI offset, blocks;
  VF du, dv;
};

HWY_INLINE Runs FindRuns(const LargeTriangle& t, int y, VI row_offsets) {
  const auto one = hn::Set(df, 1.0F);
  const auto rows = hn::Add(hn::Iota(di, 0), hn::Set(di, y));
  const auto v0 = hn::Mul(hn::ConvertTo(df, rows), hn::Set(df, static_cast<float>(kBlockHeight)));
  auto first = t.end;
  auto last = hn::Neg(one);
  auto v = v0;
  for (int i = 0; i < kBlockHeight; ++i) {
    // Thin triangles pass between the pixel centres of many rows.
    const auto low = hn::Max(hn::Max(t.a.low(v), t.b.low(v)), t.c.low(v));
    const auto high = hn::Min(hn::Min(t.a.high(v), t.b.high(v)), t.c.high(v));
    const auto from = hn::Max(hn::Ceil(low), hn::Zero(df));
    const auto to = hn::Min(hn::Floor(high), hn::Sub(t.end, one));
    const auto any = hn::Le(from, to);
    first = hn::IfThenElse(any, hn::Min(first, from), first);
    last = hn::IfThenElse(any, hn::Max(last, to), last);
    v = hn::Add(v, one);
  }
  const auto first_block = hn::ShiftRight<2>(hn::ConvertTo(di, first));
  const auto last_block = hn::ShiftRight<2>(hn::ConvertTo(di, last));
  const auto blocks = hn::Sub(hn::Add(last_block, hn::Set(di, 1)), first_block);
  Runs runs;
  runs.blocks = hn::IfThenElseZero(hn::Gt(t.height, rows), blocks);
  runs.offset = hn::Add(hn::Add(row_offsets, hn::Mul(first_block, hn::Set(di, kLanes))), t.offset);
  runs.du = hn::ConvertTo(df, hn::ShiftLeft<2>(first_block));
  runs.dv = v0;
  return runs;
}

/// Adds the runs in the marked lanes as pieces of one length.
HWY_INLINE void AddRuns(PieceBin& bin, const Runs& runs, std::int32_t record, hn::Mask<DI> mask) {
  const Packer keep(hn::RebindMask(df, mask));
  hn::StoreU(hn::Set(di, record), di, &bin.record[bin.count]);
  hn::StoreU(keep(runs.offset), di, &bin.offset[bin.count]);
  hn::StoreU(keep(runs.du), df, &bin.du[bin.count]);
  hn::StoreU(keep(runs.dv), df, &bin.dv[bin.count]);
  bin.count += keep.count();
}

/// Adds the runs of more than two blocks, which are few.
void AddLongRuns(Scratch& s, const Runs& runs, std::int32_t record, std::uint32_t lanes) {
  HWY_ALIGN std::array<std::int32_t, kStep> offset, blocks;
  HWY_ALIGN std::array<float, kStep> du, dv;
  hn::Store(runs.offset, di, offset.data());
  hn::Store(runs.blocks, di, blocks.data());
  hn::Store(runs.du, df, du.data());
  hn::Store(runs.dv, df, dv.data());
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
    AddPiece(s, {record, offset[i], du[i], dv[i]}, blocks[i]);
  }
}

/// Cuts a large triangle into runs of blocks along its block rows.
HWY_INLINE void CutIntoPieces(Scratch& s, const Record& r, int height, const Target& target) {
  const auto index = static_cast<std::int32_t>(&r - s.records.data());
  const LargeTriangle triangle(r);
  const auto row_lanes = static_cast<std::int32_t>(target.lanes_per_row);
  auto row_offsets = hn::Mul(hn::Iota(di, 0), hn::Set(di, row_lanes));
  const std::size_t most = kStep * (static_cast<std::size_t>(r.width) / Scratch::longest_piece + 1);
  for (int y = 0; y < height; y += kLanes) {
    if (HWY_UNLIKELY(s.piece_count > PieceBin::budget)) FlushPieces(s, target);
    s.piece_count += most;
    const Runs runs = FindRuns(triangle, y, row_offsets);
    AddRuns(s.pieces[0], runs, index, hn::Eq(runs.blocks, hn::Set(di, 1)));
    AddRuns(s.pieces[1], runs, index, hn::Eq(runs.blocks, hn::Set(di, 2)));
    row_offsets = hn::Add(row_offsets, hn::Set(di, row_lanes * kLanes));
    const std::uint32_t longer = Bits(hn::RebindMask(df, hn::Gt(runs.blocks, hn::Set(di, 2))));
    if (longer != 0) AddLongRuns(s, runs, index, longer);
  }
}

/// Cuts the triangles of a bin. Those of the last bin have any height, others (kBin + 1) kLanes
/// block rows at the most.
template <std::size_t kBin>
void CutBin(Scratch& s, const Target& target) {
  constexpr bool any = kBin + 1 == Scratch::large_bins;
  for (const Record& r : s.bin(Scratch::small_bins + kBin)) {
    CutIntoPieces(s, r, any ? r.height : static_cast<int>(kBin + 1) * kLanes, target);
  }
}

/// Fills all records of all bins.
template <std::size_t... kSmall, std::size_t... kLarge>
void Flush(Scratch& s, const Target& target, std::index_sequence<kSmall...> /*small*/,
           std::index_sequence<kLarge...> /*large*/) {
  (FillBlocks<static_cast<int>(kSmall % Scratch::small_width + 1),
              static_cast<int>(kSmall / Scratch::small_width + 1)>(s.bin(kSmall), target),
   ...);
  (CutBin<kLarge>(s, target), ...);
  FlushPieces(s, target);
  s.clear_bins();
}

void Flush(Scratch& s, const Target& target) {
  Flush(s, target, std::make_index_sequence<Scratch::small_bins>(),
        std::make_index_sequence<Scratch::large_bins>());
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#endif  // PENUMBRA_RENDER_CPU_PIECES_INL
