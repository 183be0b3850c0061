// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/occlusion/label_work-inl.hpp>

namespace penumbra::labelling {

/// Finds the fringe (LabelRule): a flood from the robot's measured outline into clear pixels.
class FringeFill {
 public:
  FringeFill(int width, int height, int reach);

  /// Labels the fringe in `work` and marks its tiles as touched. Returns its number of pixels.
  std::size_t label(Work& work, const DepthView& measured);

 private:
  /// An occluded pixel that touches an open one, and what the flood from it may take: depths in
  /// [nearest, farthest] that differ from their neighbour's by at most `step`, millimetres.
  struct Source {
    std::uint16_t nearest, farthest, step;
    std::int16_t u, v;
  };
  struct Pixel {
    std::int16_t u, v;
    std::uint32_t source;  ///< index in sources_
    std::uint16_t depth;   ///< millimetres
  };

  template <typename T>
  void open_clear_pixels(const Work& work, ImageView<const T> measured);
  template <typename T>
  void find_sources(const Work& work, ImageView<const T> measured);
  void add_source(const Rule& rule, int u, int v, float z);
  std::size_t flood(Work& work);

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v + 1) * pitch_ + static_cast<std::size_t>(u + 1);
  }

  int reach_;
  std::size_t pitch_;
  /// Millimetres where a pixel near the robot is clear and measured, else 0; with a rim of zeros.
  std::vector<std::uint16_t> open_;
  std::vector<Source> sources_;
  std::unique_ptr<Pixel[]> queue_;  // room for all pixels; begins with one for each source
  TileMask reachable_;
};

}  // namespace penumbra::labelling
