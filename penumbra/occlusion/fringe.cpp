// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>

#include <hwy/highway.h>

#include <penumbra/occlusion/fringe-inl.hpp>
#include <penumbra/occlusion/region_spans-inl.hpp>

namespace penumbra::labelling {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Eight = hn::FixedTag<std::uint16_t, 8>;
using Four = hn::FixedTag<std::uint16_t, 4>;

constexpr auto clear = static_cast<std::uint8_t>(Label::clear);
constexpr auto occluded = static_cast<std::uint8_t>(Label::occluded);
constexpr auto fringe = static_cast<std::uint8_t>(Label::fringe);

constexpr float millimetres_per_metre = 1000.0f;
constexpr std::uint16_t reached_once = 0x8000;  // a flag beside an open pixel's depth
constexpr float farthest = 32.767f;             // metres; pixels past it are not open

std::uint16_t rounded(float millimetres) { return static_cast<std::uint16_t>(millimetres + 0.5f); }

}  // namespace

/// From a depth image's values to millimetres; 0: no measurement, or one past `farthest`.
template <typename T>
class Millimetres;

template <>
class Millimetres<float> {
 public:
  explicit Millimetres(const Rule& rule)
      : near_(rule.metres.near), far_(std::min(rule.metres.far, farthest)) {}
  std::uint16_t operator()(float depth) const {
    const bool is_open = (near_ <= depth) & (depth <= far_);
    return rounded(is_open ? depth * millimetres_per_metre : 0.0f);
  }

 private:
  float near_, far_;
};

template <>
class Millimetres<std::uint16_t> {
 public:
  explicit Millimetres(const Rule& rule)
      : near_(rounded(rule.millimetres.near * millimetres_per_metre)),
        far_(rounded(std::min(rule.millimetres.far, farthest) * millimetres_per_metre)) {}
  std::uint16_t operator()(std::uint16_t depth) const {
    return (near_ <= depth) & (depth <= far_) ? depth : std::uint16_t{0};
  }

 private:
  std::uint16_t near_, far_;
};

FringeFill::FringeFill(int width, int height, int reach)
    : reach_(reach), pitch_(static_cast<std::size_t>(width) + 4), reachable_(width, height) {
  if (reach == 0) return;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  open_.resize(pitch_ * static_cast<std::size_t>(height + 2));
  sources_.reserve(pixels);
  queue_ = std::make_unique_for_overwrite<Pixel[]>(pixels);
  column_.resize(static_cast<std::size_t>(width) + 2);
  outline_.resize(static_cast<std::size_t>(width));
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

/// In all tiles that the flood may reach.
template <typename T>
void FringeFill::open_clear_pixels(const Work& work, ImageView<const T> measured) {
  const Millimetres<T> millimetres(work.rule);
  const ImageView<const std::uint8_t> labels = work.labels.view();
  reachable_.tile_width = work.touched.tile_width;
  for (std::size_t j = 0; j < reachable_.rows.size(); ++j)
    reachable_.rows[j] = marked_around(work.touched, j, reach_);
  reachable_.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) {
      const std::uint8_t* const label = labels.row(v);
      const T* const depth = measured.row(v);
      std::uint16_t* const open = open_.data() + index(0, v);
      for (int u = u0; u < u1; ++u)
        open[u] = label[u] == clear ? millimetres(depth[u]) : std::uint16_t{0};
    }
  });
}

template <typename T>
void FringeFill::find_sources(const Work& work, ImageView<const T> measured) {
  const ImageView<const std::uint8_t> labels = work.labels.view();
  work.touched.for_each_span([&](int u0, int u1, int v0, int v1) {
    const int left = std::max(u0 - 1, 0), right = std::min(u1 + 1, work.width);
    for (int v = v0; v < v1; ++v) {
      const std::uint8_t* const above = labels.row(std::max(v - 1, 0));
      const std::uint8_t* const here = labels.row(v);
      const std::uint8_t* const below = labels.row(std::min(v + 1, work.height - 1));
      std::uint8_t* const column = column_.data() + 1;  // the image's first and last count twice
      for (int u = left; u < right; ++u)
        column[u] = std::min(std::min(above[u], below[u]), here[u]);
      column[-1] = column[0];
      column[work.width] = column[work.width - 1];
      for (int u = u0; u < u1; ++u) {
        const std::uint8_t least = std::min(std::min(column[u - 1], column[u + 1]), column[u]);
        outline_[static_cast<std::size_t>(u)] = (least == clear) & (here[u] == occluded) ? 1 : 0;
      }
      for (int u = u0; (u += first_set(&outline_[static_cast<std::size_t>(u)], u1 - u)) < u1; ++u)
        add_source(work.rule, u, v, metres(measured(u, v)));
    }
  });
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

}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();
