// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <penumbra/base/image.hpp>
#include <penumbra/base/recent_values.hpp>

namespace penumbra {

/// The depth images of the last span of time, so that frames can be labelled again.
class RecentDepth {
 public:
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;  // 580 images of 1280x720, 16 bit

  /// `span`: nanoseconds; 0 stores nothing.
  explicit RecentDepth(std::int64_t span) : span_(span) {}

  /// Copies an image; replaces one of the same stamp.
  void keep(std::int64_t stamp, const DepthView& depth);

  /// Returns the image of exactly that stamp. Valid until the next keep().
  [[nodiscard]] std::optional<DepthView> find(std::int64_t stamp) const;

  [[nodiscard]] bool is_enabled() const { return span_ > 0; }
  void clear();

 private:
  struct Kept {
    std::optional<std::int64_t> stamp;
    DepthView view;  // of one of the two images; empty if the frame had no depth
    Image<std::uint16_t> millimetres;
    Image<float> metres;
  };

  [[nodiscard]] Kept& place_for(std::int64_t stamp, std::size_t bytes);

  std::int64_t span_;
  std::deque<Kept> kept_;  // a deque keeps views valid as it grows
};

}  // namespace penumbra
