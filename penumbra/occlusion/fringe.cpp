// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>

#include <hwy/highway.h>

#include <penumbra/occlusion/fringe-inl.hpp>

namespace penumbra::labelling {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Eight = hn::FixedTag<std::uint16_t, 8>;
using Four = hn::FixedTag<std::uint16_t, 4>;

constexpr auto clear = static_cast<std::uint8_t>(Label::clear);
constexpr auto occluded = static_cast<std::uint8_t>(Label::occluded);
constexpr auto fringe = static_cast<std::uint8_t>(Label::fringe);

constexpr std::size_t rim = 10;  // pixels that whole vectors may run over a row's end
constexpr float millimetres_per_metre = 1000.0f;
constexpr std::uint16_t reached_once = 0x8000;  // a flag beside an open pixel's depth
constexpr float farthest = 32.767f;             // metres; pixels past it are not open

std::uint16_t rounded(float millimetres) {
  return static_cast<std::uint16_t>((static_cast<std::uint32_t>(2.0f * millimetres) + 1) / 2);
}

}  // namespace

FringeFill::FringeFill(int width, int height, int reach)
    : reach_(reach), pitch_(static_cast<std::size_t>(width) + rim), reachable_(width, height) {
  if (reach == 0) return;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  open_.resize(pitch_ * static_cast<std::size_t>(height + 2) + rim);
  sources_.reserve(pixels);
  queue_ = std::make_unique_for_overwrite<Pixel[]>(pixels);
}

void FringeFill::add_source(const Rule& rule, int u, int v, float z) {
  if (z > farthest) return;
  const float millimetres = z * millimetres_per_metre;
  const float e = (rule.a + (rule.b + rule.c * z) * z) * millimetres_per_metre;
  const float drift = static_cast<float>(LabelRule::fringe_drift) * e;
  const float step = static_cast<float>(LabelRule::fringe_step) * e;
  const auto at_u = static_cast<std::int16_t>(u), at_v = static_cast<std::int16_t>(v);
  queue_[sources_.size()] = {at_u, at_v, static_cast<std::uint32_t>(sources_.size()),
                             rounded(millimetres)};
  sources_.push_back({rounded(std::max(millimetres - drift, 1.0f)),
                      rounded(std::min(millimetres + drift, farthest * millimetres_per_metre)),
                      rounded(std::min(step, millimetres)), at_u, at_v});
}

}  // namespace penumbra::labelling

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {

/// Copies depths of clear pixels to millimetres, else 0. `count`: of the row.
void open_row(const Rule& rule, const std::uint8_t* labels, const std::uint16_t* depth, int count,
              std::uint16_t* open) {
  const std::uint16_t near = rounded(rule.millimetres.near * millimetres_per_metre);
  const float far = std::min(rule.millimetres.far, farthest) * millimetres_per_metre;
  const auto nearest = hn::Set(Eight(), near), last = hn::Set(Eight(), rounded(far));
  const hn::Rebind<std::uint8_t, Eight> bytes;
  int u = 0;
  for (; u + 8 <= count; u += 8) {
    const auto d = hn::LoadU(Eight(), depth + u);
    const auto label = hn::PromoteTo(Eight(), hn::LoadU(bytes, labels + u));
    const auto is_clear = hn::Eq(label, hn::Set(Eight(), clear));
    const auto is_in_range = hn::Eq(hn::Min(hn::Max(d, nearest), last), d);
    hn::StoreU(hn::IfThenElseZero(hn::And(is_clear, is_in_range), d), Eight(), open + u);
  }
  for (; u < count; ++u) {
    const bool is_open = labels[u] == clear && near <= depth[u] && depth[u] <= rounded(far);
    open[u] = is_open ? depth[u] : std::uint16_t{0};
  }
}

void open_row(const Rule& rule, const std::uint8_t* labels, const float* depth, int count,
              std::uint16_t* open) {
  const float near = rule.metres.near, far = std::min(rule.metres.far, farthest);
  for (int u = 0; u < count; ++u) {
    const bool is_open = labels[u] == clear && near <= depth[u] && depth[u] <= far;
    open[u] = is_open ? rounded(depth[u] * millimetres_per_metre) : std::uint16_t{0};
  }
}

/// In all tiles that the flood may reach.
template <typename T>
void FringeFill::open_clear_pixels(const Work& work, ImageView<const T> measured) {
  const ImageView<const std::uint8_t> labels = work.labels.view();
  reachable_.tile_width = work.touched.tile_width;
  for (std::size_t j = 0; j < reachable_.rows.size(); ++j)
    reachable_.rows[j] = marked_around(work.touched, j, reach_);
  reachable_.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v)
      open_row(work.rule, labels.row(v) + u0, measured.row(v) + u0, u1 - u0, &open_[index(u0, v)]);
  });
}

/// Occluded pixels that have an open one among their eight neighbours.
template <typename T>
void FringeFill::find_sources(const Work& work, ImageView<const T> measured) {
  const ImageView<const std::uint8_t> labels = work.labels.view();
  const auto pitch = static_cast<std::ptrdiff_t>(pitch_);
  const auto row_around = [](const std::uint16_t* open) HWY_ATTR {
    return hn::Or(hn::Or(hn::LoadU(Eight(), open - 1), hn::LoadU(Eight(), open)),
                  hn::LoadU(Eight(), open + 1));
  };
  work.touched.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int v = v0; v < v1; ++v) {
      const std::uint8_t* const label = labels.row(v);
      const std::uint16_t* const open = &open_[index(0, v)];
      for (int u = u0; u < u1; u += 8) {
        const auto around = hn::Or(hn::Or(row_around(open + u - pitch), row_around(open + u)),
                                   row_around(open + u + pitch));
        if (hn::AllTrue(Eight(), hn::Eq(around, hn::Zero(Eight())))) continue;
        std::array<std::uint16_t, 8> is_near;
        hn::StoreU(around, Eight(), is_near.data());
        for (int i = 0; i < std::min(8, u1 - u); ++i)
          if (label[u + i] == occluded && is_near[static_cast<std::size_t>(i)] != 0)
            add_source(work.rule, u + i, v, metres(measured(u + i, v)));
      }
    }
  });
}

/// Breadth first, so that each pixel comes from a near part of the outline. What the loop uses is
/// local: writes of bytes, as those to labels, may change any member for all the compiler knows.
std::size_t FringeFill::flood(Work& work) {
  const int tile_shift = std::countr_zero(static_cast<unsigned>(work.touched.tile_width));
  const auto pitch = static_cast<std::ptrdiff_t>(pitch_);
  const std::array<std::ptrdiff_t, 12> neighbours = {
      -pitch - 1, -pitch, -pitch + 1, 0, pitch - 1, pitch, pitch + 1, 0, -1, 0 /*self*/, 1, 0};
  constexpr unsigned all = 0x577;  // the bits of eight of them
  const auto depths = [](const std::uint16_t* open) HWY_ATTR {
    return hn::And(hn::LoadU(Four(), open), hn::Set(Four(), reached_once - 1));
  };
  const auto among = [](auto tag, auto depth, std::uint16_t from, std::uint16_t to) HWY_ATTR {
    const auto inside = hn::Min(hn::Max(depth, hn::Set(tag, from)), hn::Set(tag, to));
    std::array<std::uint8_t, 8> bits;  // of which Highway may write all
    hn::StoreMaskBits(tag, hn::Eq(inside, depth), bits.data());
    return static_cast<unsigned>(bits[0]);
  };
  std::uint16_t* const open = open_.data() + index(0, 0);
  std::uint8_t* const labels = work.labels.data();
  std::uint64_t* const touched = work.touched.rows.data();
  Pixel* const queue = queue_.get();
  const Source* const sources = sources_.data();
  const std::size_t first = sources_.size();
  const int width = work.width;
  const int reach_squared = (reach_ - 1) * (reach_ - 1);  // of pixels that the flood goes on from
  std::size_t end = first;
  for (std::size_t i = 0; i < end; ++i) {
    const Pixel pixel = queue[i];
    const Source source = sources[pixel.source];
    const int u = pixel.u, v = pixel.v;
    const int du = u - source.u, dv = v - source.v;
    if (du * du + dv * dv > reach_squared) continue;
    const auto from =
        static_cast<std::uint16_t>(std::max<int>(pixel.depth - source.step, source.nearest));
    const auto to =
        static_cast<std::uint16_t>(std::min<int>(pixel.depth + source.step, source.farthest));
    std::uint16_t* const here = open + v * pitch + u;
    const auto rows = hn::Combine(Eight(), depths(here + pitch - 1), depths(here - pitch - 1));
    unsigned taken = among(Eight(), rows, from, to) | among(Four(), depths(here - 1), from, to)
                                                          << 8;
    for (taken &= all; taken != 0; taken &= taken - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(taken));
      std::uint16_t* const next = here + neighbours[bit];
      if (*next < reached_once) {
        *next |= reached_once;
        continue;
      }
      const int next_u = u + static_cast<int>(bit % 4) - 1;
      const int next_v = v + (bit < 4 ? -1 : bit < 8 ? 1 : 0);
      queue[end++] = {static_cast<std::int16_t>(next_u), static_cast<std::int16_t>(next_v),
                      pixel.source, static_cast<std::uint16_t>(*next - reached_once)};
      *next = 0;
      labels[next_v * width + next_u] = fringe;
      touched[next_v / TileMask::tile_height] |= std::uint64_t{1} << (next_u >> tile_shift);
    }
  }
  return end - first;
}

std::size_t FringeFill::label(Work& work, const DepthView& measured) {
  if (reach_ == 0) return 0;
  sources_.clear();
  std::visit(
      [&](const auto& depth) {
        open_clear_pixels(work, depth);
        find_sources(work, depth);
      },
      measured);
  return flood(work);
}

}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();
