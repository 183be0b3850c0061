// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/labels.hpp>

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

 private:
  const Rectification& rectification_;
  PixelMap map_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
  TileMask touched_;
};

/// The pixels of an image that a map to or from the raw image leaves out. No robot can be drawn
/// there in the raw image; in the pinhole image the camera sees nothing there.
class UncoveredPixels {
 public:
  explicit UncoveredPixels(ImageView<const std::int32_t> map);

  /// The labels with every uncovered pixel unknown; counts leave those out that were clear. Its
  /// tiles are those of such pixels too. Valid until the next call.
  LabelView mark(const LabelView& labels);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t marked() const { return marked_; }  ///< of them clear in the last image

  /// Not 0 where a pixel is uncovered.
  [[nodiscard]] ImageView<const std::uint8_t> mask() const { return mask_.view(); }

 private:
  Image<std::uint8_t> mask_;  // Label::unknown where not covered, else Label::clear
  Image<std::uint8_t> labels_;
  TileMask uncovered_;  // tiles of mask_ that hold such pixels
  TileMask touched_;    // tiles of labels_ that hold other than mask_
  TileMask shown_;      // both
  std::size_t count_ = 0, marked_ = 0;
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
