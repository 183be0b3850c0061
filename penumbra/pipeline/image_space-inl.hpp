// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/occlusion/labels.hpp>

namespace penumbra {

/// For every pixel of one image the pixel of another that is seen there. Columns and rows are kept
/// apart, so that a map serves images of any stride.
class PixelMap {
 public:
  explicit PixelMap(ImageView<const std::int32_t> indices, int source_width);

  /// Brings pixels u0 <= u < u1, v0 <= v < v1 of `out` from `in`; 0 where nothing is seen.
  template <typename T>
  void gather(ImageView<const T> in, int u0, int u1, int v0, int v1, ImageView<T> out) const {
    for (int v = v0; v < v1; ++v) {
      const Source* const source = sources_.view().row(v);
      T* const to = out.row(v);
      for (int u = u0; u < u1; ++u)
        to[u] = source[u].u == nowhere ? T{0} : in(source[u].u, source[u].v);
    }
  }

  [[nodiscard]] bool covers(int u, int v) const { return sources_(u, v).u != nowhere; }
  [[nodiscard]] int width() const { return sources_.width(); }
  [[nodiscard]] int height() const { return sources_.height(); }

 private:
  static constexpr std::uint16_t nowhere = 0xFFFF;  // Intrinsics::max_size is smaller
  struct Source {
    std::uint16_t u = nowhere, v = nowhere;
  };
  Image<Source> sources_;
};

/// The raw, distorted image of what was rendered in the pinhole image.
class RawImages {
 public:
  explicit RawImages(const Rectification& rectification);

  /// The virtual depth image seen in the raw image; valid until the next call.
  VirtualDepthView virtual_depth(const VirtualDepthView& pinhole);

  /// The labels of `virtual_depth`'s image, with every pixel unknown that the pinhole image does
  /// not cover, and without a tile mask; its counts leave those out. Valid until the next call.
  LabelView labels(const LabelView& labels);

  [[nodiscard]] std::size_t uncovered() const { return uncovered_count_; }

 private:
  const Rectification& rectification_;
  PixelMap map_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
  TileMask touched_;
  Image<std::uint8_t> uncovered_;  // Label::unknown where not covered, else Label::clear
  Image<std::uint8_t> labels_;
  TileMask labels_touched_;
  std::size_t uncovered_count_ = 0;
};

/// A raw depth image brought to the pinhole image.
class RectifiedDepth {
 public:
  explicit RectifiedDepth(const Rectification& rectification);

  /// The whole image: the labels' clean-up looks past the robot's tiles. Valid until the next call.
  DepthView rectify(const DepthView& raw);

 private:
  template <typename T>
  DepthView rectify_into(Image<T>& image, ImageView<const T> raw);

  PixelMap map_;
  Image<std::uint16_t> millimetres_;  // each is made when the first depth image of its kind comes
  Image<float> metres_;
};

}  // namespace penumbra
