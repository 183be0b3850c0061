// SPDX-License-Identifier: Apache-2.0
// Triangles that edge functions in float do not fit: next to no area, or far too long for it.
#if defined(PENUMBRA_RENDER_CPU_SLIVER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_RENDER_CPU_SLIVER_INL
#undef PENUMBRA_RENDER_CPU_SLIVER_INL
#else
#define PENUMBRA_RENDER_CPU_SLIVER_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include <penumbra/render/cpu/fill-inl.hpp>
#include <penumbra/render/cpu/kernel.hpp>
#include <penumbra/render/cpu/sliver.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

/// A triangle's outline as seen along the longer side of its box: from its first corner to its last
/// straight, and by way of its middle one.
struct SliverSpan {
  struct Side {
    float slope = 0.0F, along = 0.0F, across = 0.0F;
    Side(const std::array<float, 2>& p, const std::array<float, 2>& q)
        : slope(q[0] > p[0] ? (q[1] - p[1]) / (q[0] - p[0]) : 0.0F), along(p[0]), across(p[1]) {}
    [[nodiscard]] HWY_INLINE VF operator()(VF at) const {
      return hn::MulAdd(hn::Sub(at, hn::Set(df, along)), hn::Set(df, slope), hn::Set(df, across));
    }
  };
  using Corners = std::array<std::array<float, 2>, 3>;  // along and across

  bool upright;  // along v
  Corners corners;
  float first_along, last_along, first_across, last_across;  // pixels of its box in the image
  Side straight, to_middle, from_middle;

  SliverSpan(const ImageCorners& p, const Intrinsics& k)
      : upright(is_upright(p)),
        corners(sorted(p, upright)),
        straight(corners[0], corners[2]),
        to_middle(corners[0], corners[1]),
        from_middle(corners[1], corners[2]) {
    const auto [low, high] = std::minmax({corners[0][1], corners[1][1], corners[2][1]});
    const int size_along = upright ? k.height() : k.width();
    const int size_across = upright ? k.width() : k.height();
    first_along = std::max(std::ceil(corners[0][0]), 0.0F);
    last_along = std::min(std::floor(corners[2][0]), static_cast<float>(size_along - 1));
    first_across = std::max(std::ceil(low), 0.0F);
    last_across = std::min(std::floor(high), static_cast<float>(size_across - 1));
  }

 private:
  static Corners sorted(const ImageCorners& p, bool upright) {
    Corners corners{{{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}}};
    if (upright) {
      for (auto& corner : corners) std::swap(corner[0], corner[1]);
    }
    std::sort(corners.begin(), corners.end());
    return corners;
  }
};

/// The first and last pixel across at some pixels along that may lie in a sliver.
struct Candidates {
  VF first, last;
};

HWY_INLINE Candidates FindCandidates(const SliverSpan& span, VF at) {
  const auto margin = hn::Set(df, 0.01F);  // pixels: above the rounding; more only costs tests
  const auto one = span.straight(at);
  const auto other = hn::IfThenElse(hn::Lt(at, hn::Set(df, span.corners[1][0])), span.to_middle(at),
                                    span.from_middle(at));
  return {hn::Max(hn::Ceil(hn::Sub(hn::Min(one, other), margin)), hn::Set(df, span.first_across)),
          hn::Min(hn::Floor(hn::Add(hn::Max(one, other), margin)), hn::Set(df, span.last_across))};
}

/// Draws survivor `i`, pixel by pixel where there are any.
void DrawSliver(const FrameContext& frame, const Scratch& s, std::size_t i, const Target& target) {
  ImageCorners corners;
  for (std::size_t j = 0; j < corners.size(); ++j) corners[j] = s.survivor_pixels[j][i];
  if (!has_area(corners)) return;
  const BodyFrame& body = frame.bodies[s.survivor_body];
  std::optional<Sliver> sliver;
  const auto draw = [&](int u, int v) {
    if (!sliver) {
      sliver.emplace(frame, s.survivor_cluster[i], s.survivor_triangle[i], body, corners);
    }
    const float inverse_depth = sliver->inverse_depth(u, v);
    if (inverse_depth == 0.0F) return;
    const std::int32_t word =
        (std::bit_cast<std::int32_t>(inverse_depth) & ~frame.packing.id_mask) | body.id;
    const std::size_t block = static_cast<std::size_t>(v / kBlockHeight) * target.lanes_per_row +
                              static_cast<std::size_t>(u / block_width) * kStep;
    const int lane = v % kBlockHeight * block_width + u % block_width;
    std::int32_t& pixel = target.packed[block + static_cast<std::size_t>(lane)];
    pixel = std::max(pixel, word);
  };
  const SliverSpan span(corners, frame.view->intrinsics);
  for (float m = span.first_along; m <= span.last_along; m += static_cast<float>(kLanes)) {
    const auto at = hn::Add(hn::Iota(df, 0.0F), hn::Set(df, m));
    const Candidates found = FindCandidates(span, at);
    const auto any =
        hn::And(hn::Le(found.first, found.last), hn::Le(at, hn::Set(df, span.last_along)));
    std::uint32_t bits = Bits(any);
    if (bits == 0) continue;
    HWY_ALIGN std::array<float, kStep> first, last;
    hn::Store(found.first, df, first.data());
    hn::Store(found.last, df, last.data());
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      const int along = static_cast<int>(m) + static_cast<int>(lane);
      for (int across = static_cast<int>(first[lane]); across <= static_cast<int>(last[lane]);
           ++across) {
        draw(span.upright ? across : along, span.upright ? along : across);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#endif  // PENUMBRA_RENDER_CPU_SLIVER_INL
