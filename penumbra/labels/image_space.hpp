// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra {

/// Maps each pixel of one image to a pixel of another. Stores columns and rows, so that images may
/// have any stride.
class PixelMap {
 public:
  explicit PixelMap(ImageView<const std::int32_t> indices, int source_width);

  /// Writes pixels u0 <= u < u1, v0 <= v < v1 of `out` from `in`; 0 for pixels without a source.
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

/// Maps rendered pinhole images to the raw, distorted image.
class RawImages {
 public:
  explicit RawImages(const Rectification& rectification);

  /// Returns the raw virtual depth image; valid until the next call.
  VirtualDepthView virtual_depth(const VirtualDepthView& pinhole);

 private:
  const Rectification& rectification_;
  PixelMap map_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
  TileMask touched_;
};

/// The pixels of an image without a counterpart in the other image space. In the raw image no robot
/// can be rendered there; in the pinhole image the camera sees nothing there.
class UncoveredPixels {
 public:
  explicit UncoveredPixels(ImageView<const std::int32_t> map);

  /// Returns the labels with every uncovered pixel unknown; its tiles include those of uncovered
  /// pixels, its counts exclude uncovered pixels that were clear. Valid until the next call.
  LabelView mark(const LabelView& labels);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t marked() const {
    return marked_;
  }  ///< those that were clear in the last image

  /// Not 0 for uncovered pixels.
  [[nodiscard]] ImageView<const std::uint8_t> mask() const { return mask_.view(); }

 private:
  Image<std::uint8_t> mask_;
  Image<std::uint8_t> labels_;
  TileMask tiles_;  // with uncovered pixels
  TileMask shown_;  // and those of the labels
  std::size_t count_ = 0, marked_ = 0;
};

/// Rectifies raw depth images.
class RectifiedDepth {
 public:
  explicit RectifiedDepth(const Rectification& rectification);

  /// Returns the whole rectified image, which the clean-up of labels needs. Valid until the next
  /// call.
  DepthView rectify(const DepthView& raw);

 private:
  template <typename T>
  DepthView rectify_into(Image<T>& image, ImageView<const T> raw);

  PixelMap map_;
  Image<std::uint16_t> millimetres_;  // allocated with the first depth image of its type
  Image<float> metres_;
};

}  // namespace penumbra
