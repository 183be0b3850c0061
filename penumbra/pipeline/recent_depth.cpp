// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <variant>

#include <penumbra/base/stamps.hpp>
#include <penumbra/pipeline/recent_depth-inl.hpp>

namespace penumbra {
namespace {

template <typename T>
ImageView<const T> copy(ImageView<const T> source, Image<T>& image) {
  image.fit(source.width, source.height);
  for (int v = 0; v < source.height; ++v)
    std::copy(source.row(v), source.row(v) + source.width, &image(0, v));
  return std::as_const(image).view();
}

std::size_t bytes_of(const DepthView& depth) {
  return std::visit(
      [](const auto& view) {
        return static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height) *
               sizeof(*view.data);
      },
      depth);
}

}  // namespace

void RecentDepth::keep(std::int64_t stamp, const DepthView& depth) {
  if (!is_enabled()) return;
  Kept& kept = place_for(stamp, bytes_of(depth));
  kept.stamp = stamp;
  if (const auto* millimetres = std::get_if<ImageView<const std::uint16_t>>(&depth))
    kept.view = copy(*millimetres, kept.millimetres);
  else
    kept.view = copy(std::get<ImageView<const float>>(depth), kept.metres);
}

/// Returns the entry of the same stamp, else the most distant one outside the span, else a new one.
RecentDepth::Kept& RecentDepth::place_for(std::int64_t stamp, std::size_t bytes) {
  Kept* farthest = nullptr;
  std::uint64_t most = 0;
  for (Kept& kept : kept_) {
    const std::uint64_t far = kept.stamp ? stamp_distance(*kept.stamp, stamp) : ~std::uint64_t{0};
    if (far == 0) return kept;
    if (far > most) {
      most = far;
      farthest = &kept;
    }
  }
  const std::size_t places =
      std::clamp<std::size_t>(max_bytes / std::max<std::size_t>(bytes, 1), 1, remembered_stamps);
  const bool is_over = most > static_cast<std::uint64_t>(span_) || kept_.size() >= places;
  if (farthest != nullptr && is_over) return *farthest;
  return kept_.emplace_back();
}

std::optional<DepthView> RecentDepth::find(std::int64_t stamp) const {
  for (const Kept& kept : kept_)
    if (kept.stamp == stamp) return kept.view;
  return std::nullopt;
}

void RecentDepth::clear() {
  for (Kept& kept : kept_) kept.stamp.reset();
}

}  // namespace penumbra
