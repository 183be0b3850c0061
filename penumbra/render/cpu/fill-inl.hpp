// SPDX-License-Identifier: Apache-2.0
// From records to the depth buffer: one unrolled routine for each size of triangle.
#if defined(PENUMBRA_RENDER_CPU_FILL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_RENDER_CPU_FILL_INL
#undef PENUMBRA_RENDER_CPU_FILL_INL
#else
#define PENUMBRA_RENDER_CPU_FILL_INL
#endif

#include <array>
#include <cstdint>
#include <span>

#include <penumbra/render/cpu/scratch-inl.hpp>
#include <penumbra/render/cpu/simd-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

/// Constants of the fill routines.
struct Target {
  std::int32_t* packed;
  std::size_t lanes_per_row;
  VI keep;  // mask of the bits that stay depth
};

/// A vector of values at one block's pixels.
struct Values {
  VF edge0, edge1, edge2, inverse_depth;
};

HWY_INLINE Values Slope(const Record::Quartet& q, float factor) {
  const auto f = hn::Set(df, factor);
  return {hn::Mul(hn::Set(df, q.edge0), f), hn::Mul(hn::Set(df, q.edge1), f),
          hn::Mul(hn::Set(df, q.edge2), f), hn::Mul(hn::Set(df, q.inverse_depth), f)};
}

HWY_INLINE void Advance(Values& values, const Values& slope) {
  values.edge0 = hn::Add(values.edge0, slope.edge0);
  values.edge1 = hn::Add(values.edge1, slope.edge1);
  values.edge2 = hn::Add(values.edge2, slope.edge2);
  values.inverse_depth = hn::Add(values.inverse_depth, slope.inverse_depth);
}

HWY_INLINE Values Start(const Record& r, VF du, VF dv) {
  const auto at = [&](float base, float slope_u, float slope_v) HWY_ATTR {
    return hn::MulAdd(hn::Set(df, slope_u), du,
                      hn::MulAdd(hn::Set(df, slope_v), dv, hn::Set(df, base)));
  };
  return {at(r.base.edge0, r.du.edge0, r.dv.edge0), at(r.base.edge1, r.du.edge1, r.dv.edge1),
          at(r.base.edge2, r.du.edge2, r.dv.edge2),
          at(r.base.inverse_depth, r.du.inverse_depth, r.dv.inverse_depth)};
}

/// The depth test: the maximum of what is there and, in lanes where no edge function is negative,
/// of 1/z with the id in its low bits.
HWY_INLINE void Update(std::int32_t* block, const Values& v, VI keep, VI id) {
  const auto outside = hn::Or(hn::Or(v.edge0, v.edge1), v.edge2);
  const auto word = hn::Or(hn::And(hn::BitCast(di, v.inverse_depth), keep), id);
  const auto inside =
      hn::BitCast(di, hn::IfNegativeThenElse(outside, hn::Zero(df), hn::BitCast(df, word)));
  hn::Store(hn::Max(hn::Load(di, block), inside), di, block);
}

/// u and v of each lane's pixel from the block's first.
HWY_INLINE VF LaneU() {
  return hn::ConvertTo(df, hn::And(hn::Iota(di, 0), hn::Set(di, block_width - 1)));
}
HWY_INLINE VF LaneV() { return hn::ConvertTo(df, hn::ShiftRight<2>(hn::Iota(di, 0))); }

template <int kWidth, int kHeight>
void FillBlocks(std::span<const Record> records, const Target& target) {
  const auto lane_u = LaneU();
  const auto lane_v = LaneV();
  for (const Record& r : records) {
    const auto id = hn::Set(di, r.id);
    Values row = Start(r, lane_u, lane_v);
    [[maybe_unused]] const Values right = Slope(r.du, block_width);
    [[maybe_unused]] const Values down = Slope(r.dv, kBlockHeight);
    std::int32_t* block = target.packed + r.offset;
    HWY_UNROLL(8) for (int y = 0; y < kHeight; ++y) {
      Values values = row;
      HWY_UNROLL(4) for (int x = 0; x < kWidth; ++x) {
        Update(block + x * kLanes, values, target.keep, id);
        if (x + 1 < kWidth) Advance(values, right);
      }
      if (y + 1 < kHeight) {
        Advance(row, down);
        block += target.lanes_per_row;
      }
    }
  }
}

template <int kWidth>
void FillPieces(const PieceBin& bin, const Record* records, const Target& target) {
  const auto lane_u = LaneU();
  const auto lane_v = LaneV();
  for (std::size_t i = 0; i < bin.count; ++i) {
    const Record& r = records[bin.record[i]];
    const auto id = hn::Set(di, r.id);
    Values values =
        Start(r, hn::Add(lane_u, hn::Set(df, bin.du[i])), hn::Add(lane_v, hn::Set(df, bin.dv[i])));
    [[maybe_unused]] const Values right = Slope(r.du, block_width);
    std::int32_t* block = target.packed + bin.offset[i];
    HWY_UNROLL(8) for (int x = 0; x < kWidth; ++x) {
      Update(block + x * kLanes, values, target.keep, id);
      if (x + 1 < kWidth) Advance(values, right);
    }
  }
}

template <std::size_t... kLengths>
void FlushPieces(Scratch& s, const Target& target, std::index_sequence<kLengths...> /*lengths*/) {
  const Record* records = s.records.data();
  (FillPieces<static_cast<int>(kLengths + 1)>(s.pieces[kLengths], records, target), ...);
  for (PieceBin& bin : s.pieces) bin.count = 0;
  s.piece_count = 0;
}

void FlushPieces(Scratch& s, const Target& target) {
  FlushPieces(s, target, std::make_index_sequence<Scratch::longest_piece>());
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#endif  // PENUMBRA_RENDER_CPU_FILL_INL
