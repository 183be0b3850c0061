// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <variant>

#include <penumbra/labels/image_space.hpp>

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
    : mask_(map.width, map.height), tiles_(map.width, map.height), shown_(map.width, map.height) {
  for (int v = 0; v < map.height; ++v) {
    for (int u = 0; u < map.width; ++u) {
      if (map(u, v) != Rectification::no_pixel) continue;
      mask_(u, v) = 1;
      tiles_.mark(u, v, u, v);
      ++count_;
    }
  }
  marked_ = count_;
}

LabelView UncoveredPixels::mark(const LabelView& labels) {
  if (count_ == 0) return labels;
  if (labels_.empty()) labels_ = Image<std::uint8_t>(mask_.width(), mask_.height());
  for (int v = 0; v < mask_.height(); ++v)
    std::copy_n(labels.labels.row(v), mask_.width(), &labels_(0, v));
  std::size_t robot = 0, fringe = 0;  // the other uncovered pixels are clear
  tiles_.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u) {
        if (mask_(u, v) == 0) continue;
        std::uint8_t& label = labels_(u, v);
        robot += label == static_cast<std::uint8_t>(Label::unknown);
        fringe += label == static_cast<std::uint8_t>(Label::fringe);
        label = static_cast<std::uint8_t>(Label::unknown);
      }
  });
  marked_ = count_ - robot;
  for (std::size_t j = 0; j < shown_.rows.size(); ++j)
    shown_.rows[j] = labels.touched->rows[j] | tiles_.rows[j];
  LabelView covered{labels_.view(), labels.pixels, &shown_};
  covered.pixels[static_cast<std::size_t>(Label::clear)] -= marked_ - fringe;
  covered.pixels[static_cast<std::size_t>(Label::fringe)] -= fringe;
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
