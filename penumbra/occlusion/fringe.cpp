// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include <penumbra/occlusion/fringe-inl.hpp>

namespace penumbra::labelling {
namespace {

constexpr auto clear = static_cast<std::uint8_t>(Label::clear);
constexpr auto occluded = static_cast<std::uint8_t>(Label::occluded);
constexpr auto beyond = static_cast<std::uint8_t>(Label::beyond);
constexpr auto fringe = static_cast<std::uint8_t>(Label::fringe);
constexpr std::uint8_t reached_once = 0xFF;  // stands in the label image during the flood

}  // namespace

FringeFill::FringeFill(int width, int height, int reach) : reach_(reach) {
  if (reach == 0) return;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  queue_.reserve(pixels);
  once_.reserve(pixels);
  column_.resize(static_cast<std::size_t>(width) + 2);
  square_.resize(static_cast<std::size_t>(width));
}

std::size_t FringeFill::label(Work& work, const DepthView& measured) {
  if (reach_ == 0) return 0;
  return std::visit(
      [&](const auto& depth) {
        queue_.clear();
        find_outline(work, depth);
        const std::size_t outline = queue_.size();
        flood(work, depth);
        return queue_.size() - outline;
      },
      measured);
}

/// Queues the occluded and beyond pixels that have a clear one among their eight neighbours.
template <typename T>
void FringeFill::find_outline(const Work& work, ImageView<const T> measured) {
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
      for (int u = u0; u < u1; ++u)
        square_[u] = std::min(std::min(column[u - 1], column[u + 1]), column[u]);
      for (int u = u0; u < u1; ++u) {
        if (square_[u] != clear || (here[u] != occluded && here[u] != beyond)) continue;
        const auto x = static_cast<std::int16_t>(u), y = static_cast<std::int16_t>(v);
        const float depth = metres(measured(u, v));
        queue_.push_back({x, y, x, y, depth, depth});
      }
    }
  });
}

/// Breadth first, so that each pixel comes from a near part of the outline.
template <typename T>
void FringeFill::flood(Work& work, ImageView<const T> measured) {
  const MeasuredRange range =
      std::is_same_v<T, float> ? work.rule.metres : work.rule.millimetres;
  const int tile_shift = std::countr_zero(static_cast<unsigned>(work.touched.tile_width));
  const int reach_squared = reach_ * reach_;
  once_.clear();
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const Pixel pixel = queue_[i];
    const float e = work.rule.a + (work.rule.b + work.rule.c * pixel.from_depth) * pixel.from_depth;
    const float step = static_cast<float>(LabelRule::fringe_step) * e;
    const float drift = static_cast<float>(LabelRule::fringe_drift) * e;
    const int v_end = std::min(pixel.v + 2, work.height), u_end = std::min(pixel.u + 2, work.width);
    for (int v = std::max(pixel.v - 1, 0); v < v_end; ++v) {
      std::uint8_t* const labels = &work.labels(0, v);
      for (int u = std::max(pixel.u - 1, 0); u < u_end; ++u) {
        if (labels[u] != clear && labels[u] != reached_once) continue;
        const float depth = metres(measured(u, v));
        const int du = u - pixel.from_u, dv = v - pixel.from_v;
        if (!(range.near <= depth && depth <= range.far) ||
            std::abs(depth - pixel.depth) > step || std::abs(depth - pixel.from_depth) > drift ||
            du * du + dv * dv > reach_squared)
          continue;
        if (labels[u] == clear) {
          labels[u] = reached_once;
          once_.push_back(labels + u);
          continue;
        }
        labels[u] = fringe;
        work.touched.rows[static_cast<std::size_t>(v / TileMask::tile_height)] |=
            std::uint64_t{1} << (u >> tile_shift);
        queue_.push_back({static_cast<std::int16_t>(u), static_cast<std::int16_t>(v), pixel.from_u,
                          pixel.from_v, depth, pixel.from_depth});
      }
    }
  }
  for (std::uint8_t* const label : once_)
    if (*label == reached_once) *label = clear;
}

}  // namespace penumbra::labelling
