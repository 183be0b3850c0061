// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <variant>

#include <penumbra/pipeline/image_space-inl.hpp>

namespace penumbra {
namespace {

template <typename T>
void clear(const TileMask& tiles, Image<T>& image) {
  tiles.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v)
      std::fill(image.view().row(v) + u0, image.view().row(v) + u1, T{0});
  });
}

}  // namespace

PixelMap::PixelMap(ImageView<const std::int32_t> indices, int source_width)
    : sources_(indices.width, indices.height) {
  for (int v = 0; v < indices.height; ++v) {
    for (int u = 0; u < indices.width; ++u) {
      const std::int32_t index = indices(u, v);
      if (index == Rectification::no_pixel) continue;
      sources_(u, v) = {static_cast<std::uint16_t>(index % source_width),
                        static_cast<std::uint16_t>(index / source_width)};
    }
  }
}

RawImages::RawImages(const Rectification& rectification)
    : rectification_(rectification),
      map_(rectification.raw_to_pinhole(), rectification.pinhole().width()),
      depth_(map_.width(), map_.height()),
      links_(map_.width(), map_.height()),
      touched_(map_.width(), map_.height()) {}

VirtualDepthView RawImages::virtual_depth(const VirtualDepthView& pinhole) {
  clear(touched_, depth_);
  clear(touched_, links_);
  rectification_.touched_raw(*pinhole.touched, touched_);
  touched_.for_each_span([&](int u0, int u1, int v0, int v1) {
    map_.gather(pinhole.depth, u0, u1, v0, v1, depth_.view());
    map_.gather(pinhole.links, u0, u1, v0, v1, links_.view());
  });
  return {depth_.view(), links_.view(), &touched_};
}

UncoveredPixels::UncoveredPixels(ImageView<const std::int32_t> map)
    : mask_(map.width, map.height),
      uncovered_(map.width, map.height),
      touched_(map.width, map.height),
      shown_(map.width, map.height) {
  for (int v = 0; v < map.height; ++v) {
    for (int u = 0; u < map.width; ++u) {
      if (map(u, v) != Rectification::no_pixel) continue;
      mask_(u, v) = static_cast<std::uint8_t>(Label::unknown);
      uncovered_.mark(u, v, u, v);
      ++count_;
    }
  }
  marked_ = count_;
  labels_ = mask_;
}

LabelView UncoveredPixels::mark(const LabelView& labels) {
  if (count_ == 0) return labels;
  touched_.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v)
      std::copy(&mask_(u0, v), &mask_(u0, v) + (u1 - u0), &labels_(u0, v));
  });
  marked_ = count_;
  std::size_t of_fringe = 0;
  labels.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    // No robot is drawn in an uncovered pixel: its label is clear, fringe, or unknown.
    for (int v = v0; v < v1; ++v) {
      const std::uint8_t* const from = labels.labels.row(v);
      const std::uint8_t* const mask = &mask_(0, v);
      std::uint8_t* const to = &labels_(0, v);
      std::uint32_t robot = 0, fringe = 0;
      for (int u = u0; u < u1; ++u) {
        to[u] = mask[u] != 0 ? mask[u] : from[u];
        robot += (mask[u] != 0) & (from[u] == static_cast<std::uint8_t>(Label::unknown));
        fringe += (mask[u] != 0) & (from[u] == static_cast<std::uint8_t>(Label::fringe));
      }
      marked_ -= robot;
      of_fringe += fringe;
    }
  });
  touched_.rows.assign(labels.touched->rows.begin(), labels.touched->rows.end());
  for (std::size_t j = 0; j < shown_.rows.size(); ++j)
    shown_.rows[j] = touched_.rows[j] | uncovered_.rows[j];
  LabelView covered{labels_.view(), labels.pixels, &shown_};
  covered.pixels[static_cast<std::size_t>(Label::clear)] -= marked_ - of_fringe;
  covered.pixels[static_cast<std::size_t>(Label::fringe)] -= of_fringe;
  return covered;
}

RectifiedDepth::RectifiedDepth(const Rectification& rectification)
    : map_(rectification.pinhole_to_raw(), rectification.raw_to_pinhole().width) {}

DepthView RectifiedDepth::rectify(const DepthView& raw) {
  if (const auto* millimetres = std::get_if<ImageView<const std::uint16_t>>(&raw))
    return rectify_into(millimetres_, *millimetres);
  return rectify_into(metres_, std::get<ImageView<const float>>(raw));
}

template <typename T>
DepthView RectifiedDepth::rectify_into(Image<T>& image, ImageView<const T> raw) {
  if (image.empty()) image = Image<T>(map_.width(), map_.height());
  map_.gather(raw, 0, map_.width(), 0, map_.height(), image.view());
  return ImageView<const T>(image.view());
}

}  // namespace penumbra
