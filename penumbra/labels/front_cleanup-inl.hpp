// SPDX-License-Identifier: Apache-2.0
// Compiled per SIMD target: the clean-up of front pixels, 64 pixels per word.
#if defined(PENUMBRA_FRONT_CLEANUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_FRONT_CLEANUP_INL
#undef PENUMBRA_FRONT_CLEANUP_INL
#else
#define PENUMBRA_FRONT_CLEANUP_INL
#endif

#include <algorithm>
#include <bit>

#include <hwy/highway.h>

#include <penumbra/labels/label_work-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using W = hn::CappedTag<std::uint64_t, 8>;
using VW = hn::Vec<W>;

HWY_INLINE int words() { return static_cast<int>(hn::Lanes(W())); }

/// Bit u of the result is bit u + s of the row, 0 < s < 64.
HWY_INLINE VW from_right(const std::uint64_t* row, int s) {
  return hn::Or(hn::ShiftRightSame(hn::LoadU(W(), row), s),
                hn::ShiftLeftSame(hn::LoadU(W(), row + 1), 64 - s));
}

/// Bit u of the result is bit u - s of the row, 0 < s < 64.
HWY_INLINE VW from_left(const std::uint64_t* row, int s) {
  return hn::Or(hn::ShiftLeftSame(hn::LoadU(W(), row), s),
                hn::ShiftRightSame(hn::LoadU(W(), row - 1), 64 - s));
}

/// A part of the bit rows: words [w0, w1), whole vectors, of rows [v0, v1).
struct Box {
  int w0, w1, v0, v1;
};

/// Returns the box around the tiles, a word wider on both sides.
inline Box box_of(const TileMask& tiles) {
  std::uint64_t columns = 0;
  int first = 0, last = 0;
  for (std::size_t j = 0; j < tiles.rows.size(); ++j) {
    if (tiles.rows[j] == 0) continue;
    if (columns == 0) first = static_cast<int>(j);
    last = static_cast<int>(j);
    columns |= tiles.rows[j];
  }
  const int u0 = std::countr_zero(columns) * tiles.tile_width;
  const int u1 = (64 - std::countl_zero(columns)) * tiles.tile_width;
  const int w0 = u0 / 64 - 1;
  const int count = (u1 + 63) / 64 + 1 - w0;
  return {w0, w0 + (count + words() - 1) / words() * words(), first * TileMask::tile_height,
          std::min((last + 1) * TileMask::tile_height, tiles.height)};
}

/// Bit u of the result: whether any of the bits u - reach .. u - 1 of the row is set, 0 < reach
/// < 64.
HWY_INLINE VW any_left(const std::uint64_t* row, int reach) {
  VW before = hn::ShiftLeft<1>(hn::LoadU(W(), row - 1)), here = from_left(row, 1);
  for (int n = 1, s; n < reach; n += s) {
    s = std::min(n, reach - n);
    here = hn::Or(here, hn::Or(hn::ShiftLeftSame(here, s), hn::ShiftRightSame(before, 64 - s)));
    before = hn::Or(before, hn::ShiftLeftSame(before, s));
  }
  return here;
}

/// Bit u of the result: whether any of the bits u + 1 .. u + reach of the row is set, 0 < reach
/// < 64.
HWY_INLINE VW any_right(const std::uint64_t* row, int reach) {
  VW after = hn::ShiftRight<1>(hn::LoadU(W(), row + 1)), here = from_right(row, 1);
  for (int n = 1, s; n < reach; n += s) {
    s = std::min(n, reach - n);
    here = hn::Or(here, hn::Or(hn::ShiftRightSame(here, s), hn::ShiftLeftSame(after, 64 - s)));
    after = hn::Or(after, hn::ShiftRightSame(after, s));
  }
  return here;
}

/// Bit u of the result: whether there is foreground within `reach` pixels on the left and right of
/// pixel u, or above and below.
HWY_INLINE VW between_foreground(Work& work, int v, int w, int reach) {
  const std::uint64_t* const row = work.foreground.row(v) + w;
  VW above = hn::Zero(W()), below = above;
  for (std::ptrdiff_t s = 1; s <= reach; ++s) {
    above = hn::Or(above, hn::LoadU(W(), row - s * work.foreground.pitch()));
    below = hn::Or(below, hn::LoadU(W(), row + s * work.foreground.pitch()));
  }
  return hn::Or(hn::And(any_left(row, reach), any_right(row, reach)), hn::And(above, below));
}

/// scratch = the foreground with filled holes, eroded from the right by width - 1 pixels.
inline void erode_rows(Work& work, const Box& box, int width) {
  for (int v = box.v0; v < box.v1; ++v) {
    std::uint64_t* const out = work.scratch.row(v);
    for (int w = box.w0; w < box.w1; w += words()) {
      VW foreground = hn::LoadU(W(), work.foreground.row(v) + w);
      const VW holes = hn::LoadU(W(), work.unmeasured.row(v) + w);
      if (!hn::AllTrue(W(), hn::Eq(holes, hn::Zero(W()))))
        foreground = hn::Or(foreground, hn::And(holes, between_foreground(work, v, w, width)));
      hn::StoreU(foreground, W(), out + w);
    }
    for (int n = 1, s; n < width; n += s) {
      s = std::min(n, width - n);
      for (int w = box.w0; w < box.w1; w += words())
        hn::StoreU(hn::And(hn::LoadU(W(), out + w), from_right(out + w, s)), W(), out + w);
    }
  }
}

/// Erodes scratch from below by width - 1 pixels.
inline void erode_columns(Work& work, const Box& box, int width) {
  for (int n = 1, s; n < width; n += s) {
    s = std::min(n, width - n);
    for (int v = box.v0; v < box.v1 - (n + s - 1); ++v)
      for (int w = box.w0; w < box.w1; w += words()) {
        std::uint64_t* const here = work.scratch.row(v) + w;
        const VW below = hn::LoadU(W(), work.scratch.row(v + s) + w);
        hn::StoreU(hn::And(hn::LoadU(W(), here), below), W(), here);
      }
  }
}

/// Dilates scratch by width - 1 pixels to the right and down.
inline void dilate(Work& work, const Box& box, int width) {
  for (int n = 1, s; n < width; n += s) {
    s = std::min(n, width - n);
    for (int v = box.v1 - 1; v >= box.v0 + s; --v)
      for (int w = box.w0; w < box.w1; w += words()) {
        std::uint64_t* const here = work.scratch.row(v) + w;
        const VW above = hn::LoadU(W(), work.scratch.row(v - s) + w);
        hn::StoreU(hn::Or(hn::LoadU(W(), here), above), W(), here);
      }
  }
  for (int v = box.v0; v < box.v1; ++v) {
    std::uint64_t* const row = work.scratch.row(v);
    for (int n = 1, s; n < width; n += s) {
      s = std::min(n, width - n);
      for (int w = box.w1 - words(); w >= box.w0; w -= words())
        hn::StoreU(hn::Or(hn::LoadU(W(), row + w), from_left(row + w, s)), W(), row + w);
    }
  }
}

/// Keeps only the seeds in scratch, all inside `seeds`, and clears the rest of `box`.
inline void keep_seeds(Work& work, const Box& box, const Box& seeds) {
  for (int v = box.v0; v < box.v1; ++v) {
    std::uint64_t* const row = work.scratch.row(v);
    const bool inside = seeds.v0 <= v && v < seeds.v1;
    for (int w = box.w0; w < box.w1; w += words()) {
      const VW front = hn::And(hn::LoadU(W(), work.front.row(v) + w),
                               hn::LoadU(W(), work.foreground.row(v) + w));
      const VW kept = hn::And(hn::LoadU(W(), row + w), front);
      hn::StoreU(inside ? kept : hn::Zero(W()), W(), row + w);
    }
  }
}

/// Makes front pixels occluded that are not in scratch, which is shifted by `reach` down and to the
/// right; outside of `valid`, all of them. Returns how many.
inline std::size_t drop_front(Work& work, const Box& valid, int reach) {
  std::size_t dropped = 0;
  work.front_tiles.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) {
      for (int w = u0 / 64; w < (u1 + 63) / 64; ++w) {
        std::uint64_t drop = work.front.row(v)[w];
        if (valid.v0 <= v && v < valid.v1 && valid.w0 <= w && w < valid.w1) {
          const std::uint64_t* const shifted = work.scratch.row(v + reach) + w;
          drop &= ~(reach == 0 ? shifted[0] : shifted[0] >> reach | shifted[1] << (64 - reach));
        }
        dropped += static_cast<std::size_t>(std::popcount(drop));
        for (; drop != 0; drop &= drop - 1)
          work.labels(64 * w + std::countr_zero(drop), v) =
              static_cast<std::uint8_t>(Label::occluded);
      }
    }
  });
  return dropped;
}

/// Makes front pixels without a seed nearby occluded; returns how many.
inline std::size_t drop_isolated(Work& work) {
  const int width = work.rule.width;
  const int reach = work.rule.reach;
  if (!any(work.foreground_tiles)) return drop_front(work, {0, 0, 0, 0}, 0);
  const Box seeds = box_of(work.foreground_tiles);
  // The squares of width x width foreground pixels. Bits are the top left corners of those that
  // may hold a seed, ...
  const Box squares{seeds.w0, seeds.w1, seeds.v0 - (width - 1), seeds.v1 + (width - 1)};
  erode_rows(work, squares, width);
  erode_columns(work, squares, width);
  // ... then their pixels.
  const Box covered{seeds.w0, seeds.w1, squares.v0, seeds.v1};
  dilate(work, covered, width);
  // The seeds, and the pixels within reach of one, shifted by `reach` down and to the right because
  // dilate() only goes there.
  const Box spread{seeds.w0, seeds.w1, seeds.v0, seeds.v1 + 2 * reach};
  keep_seeds(work, spread, seeds);
  dilate(work, spread, 2 * reach + 1);
  return drop_front(work, {seeds.w0, seeds.w1, seeds.v0 - reach, seeds.v1 + reach}, reach);
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#endif
