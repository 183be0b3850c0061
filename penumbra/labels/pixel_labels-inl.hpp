// SPDX-License-Identifier: Apache-2.0
// Compiled per SIMD target: the labels of single pixels.
#if defined(PENUMBRA_PIXEL_LABELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_PIXEL_LABELS_INL
#undef PENUMBRA_PIXEL_LABELS_INL
#else
#define PENUMBRA_PIXEL_LABELS_INL
#endif

#include <algorithm>
#include <array>
#include <cstring>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <penumbra/labels/label_vectors-inl.hpp>
#include <penumbra/labels/label_work-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {

/// Masks of a vector of pixels: all bits or none.
struct Masks {
  VI robot, measured, front, beyond;
};

HWY_INLINE Masks compare(const Criteria& rule, VF z, VF d) {
  const auto mask_of = [](hn::Mask<F> mask)
                           HWY_ATTR { return hn::BitCast(I(), hn::VecFromMask(F(), mask)); };
  const VF e = rule.tolerance(z);
  return {mask_of(hn::Gt(z, hn::Zero(F()))), hn::VecFromMask(I(), rule.measured(d)),
          mask_of(hn::Lt(d, hn::Sub(z, e))),
          mask_of(hn::Gt(d, hn::Add(z, hn::Mul(rule.beyond_factor, e))))};
}

/// Returns the masks of a chunk's four vectors as bytes, with the vectors interleaved.
HWY_INLINE VB interleave(VI p0, VI p1, VI p2, VI p3) {
  const S words;
  const auto even = hn::OddEven(hn::BitCast(words, p2), hn::BitCast(words, p0));
  const auto odd = hn::OddEven(hn::BitCast(words, p3), hn::BitCast(words, p1));
  return hn::OddEven(hn::BitCast(B(), odd), hn::BitCast(B(), even));
}

/// Sorts four interleaved vectors into the order of pixels.
HWY_INLINE VB in_order(VB bytes) {
  HWY_ALIGN static constexpr std::int8_t in_block[16] = {0, 4, 8,  12, 1, 5, 9,  13,
                                                         2, 6, 10, 14, 3, 7, 11, 15};
  bytes = hn::TableLookupBytes(bytes, hn::LoadDup128(B(), in_block));
  static_assert(lanes == 4 || lanes == 8);
  if constexpr (lanes == 8) {
    HWY_ALIGN static constexpr std::int32_t across[8] = {0, 4, 1, 5, 2, 6, 3, 7};
    const VI words = hn::BitCast(I(), bytes);
    bytes = hn::BitCast(B(), hn::TableLookupLanes(words, hn::SetTableIndices(I(), across)));
  }
  return bytes;
}

/// Counts bytes that are -1, not 0.
class ByteCounts {
 public:
  static constexpr int most = 255;  ///< additions between two calls of settle()

  HWY_INLINE ByteCounts()
      : robot_(hn::Zero(B())), unknown_(robot_), front_(robot_), beyond_(robot_) {}

  HWY_INLINE void add(VB robot, VB unknown, VB front, VB beyond) {
    robot_ = hn::Sub(robot_, robot);
    unknown_ = hn::Sub(unknown_, unknown);
    front_ = hn::Sub(front_, front);
    beyond_ = hn::Sub(beyond_, beyond);
  }

  HWY_INLINE void settle(Counts& counts) {
    const auto take = [](VB& bytes) HWY_ATTR {
      const auto sums = hn::SumsOf8(hn::BitCast(hn::Repartition<std::uint8_t, F>(), bytes));
      bytes = hn::Zero(B());
      const hn::Repartition<std::uint64_t, F> wide;
      return static_cast<std::size_t>(hn::GetLane(hn::SumOfLanes(wide, sums)));
    };
    const std::size_t unknown = take(unknown_), front = take(front_), beyond = take(beyond_);
    counts[static_cast<std::size_t>(Label::unknown)] += unknown;
    counts[static_cast<std::size_t>(Label::front)] += front;
    counts[static_cast<std::size_t>(Label::beyond)] += beyond;
    counts[static_cast<std::size_t>(Label::occluded)] += take(robot_) - unknown - front - beyond;
  }

 private:
  VB robot_, unknown_, front_, beyond_;
};

/// Labels a chunk. Returns the mask of front pixels as bytes, with the vectors interleaved.
template <typename T>
HWY_INLINE VB label_chunk(const Criteria& rule, const float* HWY_RESTRICT virtual_depth,
                          const T* HWY_RESTRICT measured, std::uint8_t* HWY_RESTRICT labels,
                          ByteCounts& counts) {
  const auto z = [&](int i) HWY_ATTR { return hn::LoadU(F(), virtual_depth + i); };
  const VF all = hn::Or(hn::Or(z(0), z(lanes)), hn::Or(z(2 * lanes), z(3 * lanes)));
  if (hn::AllTrue(F(), hn::Eq(all, hn::Zero(F())))) {
    hn::StoreU(hn::Zero(hn::Repartition<std::uint8_t, F>()), hn::Repartition<std::uint8_t, F>(),
               labels);
    return hn::Zero(B());
  }
  const auto at = [&](int i) HWY_ATTR {
    return compare(rule, hn::LoadU(F(), virtual_depth + i), load_metres(measured + i));
  };
  const Masks p0 = at(0), p1 = at(lanes), p2 = at(2 * lanes), p3 = at(3 * lanes);
  const VB robot = interleave(p0.robot, p1.robot, p2.robot, p3.robot);
  const VB seen = interleave(p0.measured, p1.measured, p2.measured, p3.measured);
  const VB unknown = hn::AndNot(seen, robot);
  const VB compared = hn::And(seen, robot);
  const VB before = interleave(p0.front, p1.front, p2.front, p3.front);
  const VB past = interleave(p0.beyond, p1.beyond, p2.beyond, p3.beyond);
  const VB front = hn::And(before, compared);
  const VB beyond = hn::AndNot(before, hn::And(past, compared));
  counts.add(robot, unknown, front, beyond);
  static_assert(static_cast<int>(Label::front) == 1 && static_cast<int>(Label::occluded) == 2 &&
                static_cast<int>(Label::unknown) == 3 && static_cast<int>(Label::beyond) == 4);
  // A true mask is -1: 2 + front = 1, 2 - unknown = 3, 2 - 2 beyond = 4. At most one of them is
  // true. A new label of robot pixels must fit this sum.
  const VB two = hn::And(robot, hn::Set(B(), 2));
  const VB values = hn::Sub(hn::Add(two, front), hn::Add(unknown, hn::Add(beyond, beyond)));
  const hn::Repartition<std::uint8_t, F> out;
  hn::StoreU(hn::BitCast(out, in_order(values)), out, labels);
  return front;
}

/// Labels a chunk of which `count` pixels are in the image.
template <typename T>
HWY_NOINLINE VB label_cut_chunk(const Criteria& rule, int count, const float* virtual_depth,
                                const T* measured, std::uint8_t* labels, ByteCounts& counts) {
  std::array<float, chunk> z{};
  std::array<T, chunk> d{};
  std::array<std::uint8_t, chunk> out;
  std::copy_n(virtual_depth, count, z.begin());
  std::copy_n(measured, count, d.begin());
  const VB front = label_chunk(rule, z.data(), d.data(), out.data(), counts);
  std::copy_n(out.begin(), count, labels);
  return front;
}

/// Stores the front pixels of the chunk that begins at (u, v).
HWY_INLINE void keep_front(Work& work, int u, int v, VB front) {
  std::array<std::uint8_t, 8> bits;  // Highway may write all of them
  hn::StoreMaskBits(B(), hn::MaskFromVec(in_order(front)), bits.data());
  std::memcpy(reinterpret_cast<std::uint8_t*>(work.front.row(v)) + u / 8, bits.data(), chunk / 8);
  work.front_tiles.rows[static_cast<std::size_t>(v / TileMask::tile_height)] |=
      std::uint64_t{1} << (u / work.touched.tile_width);
}

/// Labels the touched tiles.
template <bool keeps_front, typename T>
void label_tiles(Work& work, ImageView<const float> virtual_depth, ImageView<const T> measured,
                 Counts& counts) {
  const Criteria rule(work.rule, measured.data);
  const ImageView<std::uint8_t> labels = work.labels.view();
  const auto label_block = [&](int u0, int u1, int v0, int v1) HWY_ATTR {
    ByteCounts block;
    for (int v = v0; v < v1; ++v) {
      const float* const z = virtual_depth.row(v);
      const T* const d = measured.row(v);
      const T* const next = measured.row(std::min(v + TileMask::tile_height, measured.height - 1));
      std::uint8_t* const out = labels.row(v);
      for (int u = u0; u < u1; u += chunk) {
        hwy::Prefetch(next + u);  // the hardware does not predict short spans
        const VB front = u + chunk <= u1
                             ? label_chunk(rule, z + u, d + u, out + u, block)
                             : label_cut_chunk(rule, u1 - u, z + u, d + u, out + u, block);
        if constexpr (keeps_front)
          if (!hn::AllTrue(B(), hn::Eq(front, hn::Zero(B())))) keep_front(work, u, v, front);
      }
    }
    block.settle(counts);
  };
  constexpr int widest = ByteCounts::most / TileMask::tile_height * chunk;
  work.touched.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int u = u0; u < u1; u += widest) label_block(u, std::min(u + widest, u1), v0, v1);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#endif
