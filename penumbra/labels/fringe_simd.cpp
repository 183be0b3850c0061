// SPDX-License-Identifier: Apache-2.0
// Compiled once per SIMD target. All targets give the same fringe.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "penumbra/labels/fringe_simd.cpp"
#include <hwy/foreach_target.h>
//
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <type_traits>
#include <utility>
#include <variant>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <penumbra/labels/fringe-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr auto clear = static_cast<std::uint8_t>(Label::clear);
constexpr auto occluded = static_cast<std::uint8_t>(Label::occluded);
constexpr auto fringe = static_cast<std::uint8_t>(Label::fringe);
static_assert(clear == 0);  // fringe is written by or

constexpr std::uint16_t is_open = 0x8000;  // a flag at the depth of a clear block
constexpr std::uint16_t farthest = Fringe::farthest;
constexpr std::uint16_t nothing = 0xffff;  // a pixel's rank: neither
constexpr int contact = 16;  // pixels: stereo matching blurs the edges of things by up to 11

HWY_INLINE std::uint16_t millimetres(std::uint16_t depth) { return depth; }

/// Rounds; 0 if it is not in (0, farthest].
HWY_INLINE std::uint16_t millimetres(float depth) {
  const float rounded = depth * millimetres_per_metre + 0.5f;
  return rounded > 0.0f && rounded < farthest + 1.0f ? static_cast<std::uint16_t>(rounded)
                                                     : std::uint16_t{0};
}

using D = hn::CappedTag<std::uint16_t, 16>;
using V = hn::VFromD<D>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
constexpr int chunk = 2 * lanes;  // pixels; divides a tile

/// A chunk of a row for whole vectors; its first `count` pixels are in the image.
struct Chunk {
  template <typename T>
  HWY_INLINE Chunk(const std::uint8_t* row_labels, const T* row_depth, int count) {
    if constexpr (std::is_same_v<T, std::uint16_t>)
      if (count == chunk) {
        labels = row_labels;
        depth = row_depth;
        return;
      }
    own_labels.fill(0);
    own_depth.fill(0);
    for (int i = 0; i < count; ++i) {
      own_labels[static_cast<std::size_t>(i)] = row_labels[i];
      own_depth[static_cast<std::size_t>(i)] = millimetres(row_depth[i]);
    }
  }

  std::array<std::uint8_t, chunk> own_labels;
  std::array<std::uint16_t, chunk> own_depth;
  const std::uint8_t* labels = own_labels.data();
  const std::uint16_t* depth = own_depth.data();
};

/// Returns the ranks of pixels: the depth of an occluded one, the depth of a clear one with
/// is_open, or nothing. A block takes the least.
HWY_INLINE V ranks(const std::uint8_t* labels, const std::uint16_t* depth, V near, V far) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto d = hn::LoadU(D(), depth);
  const auto label = hn::PromoteTo(D(), hn::LoadU(bytes, labels));
  const auto is_clear = hn::Eq(label, hn::Set(D(), clear));
  const auto is_any = hn::And(hn::Or(is_clear, hn::Eq(label, hn::Set(D(), occluded))),
                              hn::Eq(hn::Min(hn::Max(d, near), far), d));
  const auto flagged = hn::Or(d, hn::IfThenElseZero(is_clear, hn::Set(D(), is_open)));
  return hn::IfThenElse(is_any, flagged, hn::Set(D(), nothing));
}

/// Returns the blocks of two chunks, one above the other.
HWY_INLINE V blocks_of(const Chunk& above, const Chunk& below, V near, V far) {
  const auto left = hn::Min(ranks(above.labels, above.depth, near, far),
                            ranks(below.labels, below.depth, near, far));
  const auto right = hn::Min(ranks(above.labels + lanes, above.depth + lanes, near, far),
                             ranks(below.labels + lanes, below.depth + lanes, near, far));
  const auto least = hn::Min(hn::ConcatEven(D(), right, left), hn::ConcatOdd(D(), right, left));
  return hn::IfThenZeroElse(hn::Eq(least, hn::Set(D(), nothing)), least);
}

/// Fills the blocks of some pixels of one tile row.
template <typename T>
void fill_blocks(Fringe& flood, const Work& work, ImageView<const T> measured, int u0, int u1,
                 int v0, int v1) {
  constexpr int ahead = 4;  // rows to prefetch
  const ImageView<const std::uint8_t> labels = work.labels.view();
  const auto near = hn::Set(D(), work.rule.range.first);
  const auto far = hn::Set(D(), std::min(work.rule.range.last, farthest));
  for (int v = v0; v < v1; v += 2) {
    const int below = std::min(v + 1, v1 - 1);
    const int next = std::min(v + ahead, measured.height - 2);
    std::uint16_t* const out = flood.block(0, v / 2);
    for (int u = u0; u < u1; u += chunk) {
      const int count = std::min(chunk, u1 - u);
      hwy::Prefetch(measured.row(next) + u);
      hwy::Prefetch(measured.row(next + 1) + u);
      const auto blocks =
          blocks_of(Chunk(labels.row(v) + u, measured.row(v) + u, count),
                    Chunk(labels.row(below) + u, measured.row(below) + u, count), near, far);
      hn::StoreU(blocks, D(), out + u / 2);
    }
  }
}

/// Fills the tiles with sources and those around; the flood fills others as it reaches them.
template <typename T>
void fill_near_robot(Fringe& flood, const Work& work, ImageView<const T> measured) {
  // The last blocks of an odd image share pixels with others, which paint() changes.
  const bool is_odd = measured.width % 2 != 0 || measured.height % 2 != 0;
  flood.begin(work.touched, is_odd ? flood.reach : 2);
  flood.filled.for_each_span(
      [&](int u0, int u1, int v0, int v1) { fill_blocks(flood, work, measured, u0, u1, v0, v1); });
}

/// Fills the tile of a block.
template <typename T>
HWY_NOINLINE void fill_tile(Fringe& flood, const Work& work, ImageView<const T> measured, int x,
                            int y) {
  const int u0 = 2 * x / flood.filled.tile_width * flood.filled.tile_width;
  const int v0 = 2 * y / TileMask::tile_height * TileMask::tile_height;
  flood.filled.mark(u0, v0, u0, v0);
  fill_blocks(flood, work, measured, u0, std::min(u0 + flood.filled.tile_width, work.width), v0,
              std::min(v0 + TileMask::tile_height, work.height));
}

/// Finds the blocks of the robot with an open one among their eight neighbours.
HWY_INLINE void find_sources(Fringe& flood, const Work& work) {
  const auto pitch = static_cast<std::ptrdiff_t>(flood.pitch);
  const auto row_around = [](const std::uint16_t* at) HWY_ATTR {
    return hn::Or(hn::Or(hn::LoadU(D(), at - 1), hn::LoadU(D(), at)), hn::LoadU(D(), at + 1));
  };
  const auto open = hn::Set(D(), is_open);
  flood.sources.clear();
  work.touched.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int y = v0 / 2; y < (v1 + 1) / 2; ++y)
      for (int x = u0 / 2; x < (u1 + 1) / 2; x += lanes) {
        const std::uint16_t* const at = flood.block(x, y);
        const auto around =
            hn::Or(hn::Or(row_around(at - pitch), row_around(at)), row_around(at + pitch));
        const auto here = hn::LoadU(D(), at);
        const auto is_robot = hn::And(hn::Lt(here, open), hn::Ne(here, hn::Zero(D())));
        std::array<std::uint8_t, 8> bytes{};  // Highway may write all of them
        hn::StoreMaskBits(D(), hn::And(is_robot, hn::TestBit(around, open)), bytes.data());
        std::uint32_t bits;
        std::memcpy(&bits, bytes.data(), sizeof bits);
        for (; bits != 0; bits &= bits - 1) {
          const int i = std::countr_zero(bits);
          flood.add_source(work.rule, x + i, y, at[i]);
        }
      }
  });
}

/// The pixels of a block.
using Four = hn::FixedTag<std::uint16_t, 4>;

template <typename Both, typename T>
HWY_INLINE Both load_two(const T* values) {
  Both both;
  std::memcpy(&both, values, sizeof both);
  return both;
}

HWY_INLINE hn::VFromD<Four> four_millimetres(const std::uint16_t* above,
                                             const std::uint16_t* below) {
  const std::uint64_t all =
      load_two<std::uint32_t>(above) | std::uint64_t{load_two<std::uint32_t>(below)} << 32;
  return hn::BitCast(Four(), hn::Set(hn::FixedTag<std::uint64_t, 1>(), all));
}

HWY_INLINE hn::VFromD<Four> four_millimetres(const float* above, const float* below) {
  const std::array<std::uint16_t, 4> all = {millimetres(above[0]), millimetres(above[1]),
                                            millimetres(below[0]), millimetres(below[1])};
  return hn::LoadU(Four(), all.data());
}

/// Labels the clear pixels of a block that differ from its depth by at most 2 `step`, millimetres.
/// Adds how many to `count`, and returns whether one of them agrees with what is known.
template <typename T>
HWY_INLINE bool paint(TileMask& touched, ImageView<std::uint8_t> labels,
                      ImageView<const T> measured, ImageView<const std::uint16_t> known,
                      Fringe::Block block, int at, std::uint16_t step, std::size_t& count) {
  const hn::FixedTag<std::uint8_t, 4> bytes;
  const hn::FixedTag<std::uint32_t, 1> word;
  const int u = std::min(2 * block.x(), labels.width - 2);
  const int v = std::min(2 * block.y(), labels.height - 2);
  const auto least = static_cast<std::uint16_t>(std::max(at - 2 * step, 0));
  const auto most = static_cast<std::uint16_t>(std::min<int>(at + 2 * step, farthest));
  std::uint8_t* const above = labels.row(v) + u;
  std::uint8_t* const below = labels.row(v + 1) + u;
  const std::uint32_t old =
      load_two<std::uint16_t>(above) | std::uint32_t{load_two<std::uint16_t>(below)} << 16;
  const auto label = hn::PromoteTo(Four(), hn::BitCast(bytes, hn::Set(word, old)));
  const auto depth = four_millimetres(measured.row(v) + u, measured.row(v + 1) + u);
  const auto is_near =
      hn::Eq(hn::Min(hn::Max(depth, hn::Set(Four(), least)), hn::Set(Four(), most)), depth);
  const auto before = four_millimetres(known.row(v) + u, known.row(v + 1) + u);
  const auto off = hn::Set(Four(), step);
  const auto is_same = hn::Eq(
      hn::Min(hn::Max(depth, hn::SaturatedSub(before, off)), hn::SaturatedAdd(before, off)), depth);
  const auto is_fringe = hn::And(is_near, hn::Eq(label, hn::Set(Four(), clear)));
  const auto painted = hn::Or(label, hn::IfThenElseZero(is_fringe, hn::Set(Four(), fringe)));
  const std::uint32_t now = hn::GetLane(hn::BitCast(word, hn::TruncateTo(bytes, painted)));
  const std::uint32_t now_below = now >> 16;
  std::memcpy(above, &now, 2);
  std::memcpy(below, &now_below, 2);
  const int tile_shift = std::countr_zero(static_cast<unsigned>(touched.tile_width));
  touched.rows[static_cast<std::size_t>(v / TileMask::tile_height)] |= std::uint64_t{1}
                                                                       << (u >> tile_shift);
  const bool is_cut = u < 2 * block.x() || v < 2 * block.y();  // by the border of an odd image
  if (is_cut) touched.mark(u, v, u + 1, v + 1);
  count += hn::CountTrue(Four(), is_fringe);
  return !hn::AllFalse(Four(), hn::And(is_same, is_fringe));
}

/// Clears the fringe pixels of a block that agree with what is known, if a clear pixel within
/// `contact` does, too. Returns how many.
template <typename T>
std::size_t confirm(ImageView<std::uint8_t> labels, ImageView<const T> measured,
                    ImageView<const std::uint16_t> known, Fringe::Block block, int step) {
  const int u0 = std::min(2 * block.x(), labels.width - 2);
  const int v0 = std::min(2 * block.y(), labels.height - 2);
  const auto is_same = [&](int u, int v, std::uint8_t label) {
    return labels(u, v) == label && known(u, v) < seen_once &&
           std::abs(millimetres(measured(u, v)) - known(u, v)) <= step;
  };
  bool is_touched = false;  // one pixel of each block is enough
  for (int v = v0 - std::min(v0, contact); v < labels.height && v <= v0 + contact && !is_touched;
       v += 2)
    for (int u = u0 - std::min(u0, contact); u < labels.width && u <= u0 + contact && !is_touched;
         u += 2)
      is_touched = is_same(u, v, clear);
  if (!is_touched) return 0;
  std::size_t count = 0;
  for (const auto& [u, v] : {std::pair(u0, v0), {u0 + 1, v0}, {u0, v0 + 1}, {u0 + 1, v0 + 1}})
    if (is_same(u, v, fringe)) {
      labels(u, v) = clear;
      ++count;
    }
  return count;
}

/// Visits blocks breadth first, so that each comes from a near part of the outline, and labels the
/// clear pixels of each that are near the block's depth. Then, from the outermost one inwards,
/// clears those that agree with what is known and have contact with such pixels outside of the
/// fringe. Returns the number of fringe pixels.
template <typename T>
std::size_t fill(Fringe& flood, Work& work, ImageView<const T> measured,
                 ImageView<const std::uint16_t> known) {
  struct Step {
    std::uint64_t block;
    std::ptrdiff_t offset;
  };
  const auto pitch = static_cast<std::ptrdiff_t>(flood.pitch);
  const std::array<Step, 4> steps = {
      {{-std::uint64_t{0x10000}, -pitch}, {-std::uint64_t{1}, -1}, {1, 1}, {0x10000, pitch}}};
  // Squared, in blocks of 2 pixels: the flood continues from blocks within (reach - 1) / 2 of their
  // source, so that it ends one block further, at most `reach` pixels (+ 1 if odd) away.
  const int continues = (flood.reach - 1) * (flood.reach - 1) / 4;
  // Local copies: writes to bytes may alias any member.
  const ImageView<std::uint8_t> labels = work.labels.view();
  Fringe::Block* const queue = flood.queue.get();
  const Fringe::Source* const sources = flood.sources.data();
  std::uint16_t* const origin = flood.block(0, 0);
  constexpr std::size_t ahead = 16;  // blocks whose memory is fetched
  std::size_t end = flood.sources.size();
  std::size_t count = 0, known_blocks = 0;
  for (std::size_t i = 0; i < end; ++i) {
    const Fringe::Block from = queue[i];
    const Fringe::Source source = sources[from.source()];
    std::uint16_t* const here = origin + from.y() * pitch + from.x();
    const int depth = *here;
    const Fringe::Block later = queue[std::min(i + ahead, end - 1)];
    for (int v = 2 * later.y(); v < std::min(2 * later.y() + 2, labels.height); ++v)
      hwy::Prefetch(known.row(v) + 2 * later.x());
    const bool is_known =
        paint(work.touched, labels, measured, known, from, depth, source.step, count);
    queue[known_blocks] = from;  // not after i
    known_blocks += is_known;
    const int dx = from.x() - source.x, dy = from.y() - source.y;
    if (dx * dx + dy * dy > continues) continue;
    const int least = std::max<int>(depth - source.step, source.nearest);
    const int most = std::min<int>(depth + source.step, source.farthest);
    const auto first = static_cast<std::uint32_t>(least | is_open);
    const auto span = static_cast<std::uint32_t>(most - least);
    for (const Step& to : steps) {  // without unpredictable branches
      std::uint16_t& next = here[to.offset];
      queue[end].bits = from.bits + to.block;
      if (HWY_UNLIKELY(next == Fringe::unfilled))
        fill_tile(flood, work, measured, queue[end].x(), queue[end].y());
      // Whether first <= next <= first + span: a smaller one, such as a block without the flag
      // is_open, wraps around to a large number.
      const bool is_taken = next - first <= span;
      end += is_taken;
      next = static_cast<std::uint16_t>(next & ~(is_taken ? is_open : 0));
    }
  }
  while (known_blocks > 0) {
    const Fringe::Block block = queue[--known_blocks];
    count -= confirm(labels, measured, known, block, sources[block.source()].step);
  }
  return count;
}

std::size_t label_fringe(Fringe& flood, Work& work, const DepthView& measured,
                         ImageView<const std::uint16_t> known) {
  if (flood.reach == 0) return 0;
  if (known.empty()) known = {flood.nothing_known.data(), work.width, work.height, 0};
  return std::visit(
      [&](const auto& depth) {
        fill_near_robot(flood, work, depth);
        find_sources(flood, work);
        return fill(flood, work, depth, known);
      },
      measured);
}

LabelFringe kernel() { return label_fringe; }

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <penumbra/base/simd_dispatch-inl.hpp>

namespace penumbra::labelling {
namespace {
HWY_EXPORT(kernel);
}

LabelFringe fringe_kernel(std::int64_t target) { return PENUMBRA_SIMD_FUNCTION(kernel, target)(); }

Fringe::Fringe(int width, int height, int reach_pixels)
    : reach(width < 2 || height < 2 ? 0 : reach_pixels),
      pitch(static_cast<std::size_t>(width + 1) / 2 + 32),
      filled(width, height) {
  if (reach == 0) return;
  blocks.resize(pitch * static_cast<std::size_t>((height + 1) / 2 + 2) + 32);
  filled.mark(0, 0, width - 1, height - 1);  // so that begin() empties all
  sources.reserve(blocks.size());
  queue = std::make_unique_for_overwrite<Block[]>(blocks.size() + 1);
  nothing_known.assign(static_cast<std::size_t>(width), saturated_depth);
}

void Fringe::begin(const TileMask& touched, int pixels) {
  filled.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int y = v0 / 2; y < (v1 + 1) / 2; ++y)
      std::fill(block(u0 / 2, y), block((u1 + 1) / 2, y), unfilled);
  });
  filled.tile_width = touched.tile_width;
  for (std::size_t j = 0; j < filled.rows.size(); ++j)
    filled.rows[j] = marked_around(touched, j, pixels);
}

void Fringe::add_source(const Rule& rule, int x, int y, std::uint16_t depth) {
  const float z = static_cast<float>(depth) / millimetres_per_metre;
  const float e =
      std::min((rule.a + (rule.b + rule.c * z) * z) * millimetres_per_metre, float{farthest});
  const auto drift = static_cast<int>(static_cast<float>(LabelRule::fringe_drift) * e);
  const auto step = static_cast<int>(static_cast<float>(LabelRule::fringe_step) * e);
  queue[sources.size()] = Block(x, y, sources.size());
  sources.push_back({static_cast<std::uint16_t>(std::max(depth - drift, 1)),
                     static_cast<std::uint16_t>(std::min<int>(depth + drift, farthest)),
                     static_cast<std::uint16_t>(std::min<int>(step, depth)),
                     static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)});
}

}  // namespace penumbra::labelling
#endif
