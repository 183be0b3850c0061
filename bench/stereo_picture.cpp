// SPDX-License-Identifier: Apache-2.0
#include "stereo_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::study {
namespace {

io::Rgb8 depth_color(double metres) {
  if (!(metres > 0.0)) return {};
  constexpr double nearest = 0.4, span = 2.2;
  const double x = std::clamp((metres - nearest) / span, 0.0, 1.0);
  const auto wave = [&](double centre) {
    return static_cast<std::uint8_t>(255.0 *
                                     std::clamp(1.5 - std::abs(4.0 * x - centre), 0.0, 1.0));
  };
  return {wave(1.0), wave(2.0), wave(3.0)};
}

constexpr std::array<io::Rgb8, label_count> label_colors = {
    {{70, 70, 70}, {60, 200, 80}, {210, 60, 50}, {150, 110, 200}, {60, 120, 220}, {250, 200, 40}}};

}  // namespace

Image<io::Rgb8> picture(const StereoImages& images, const LabelView& labels) {
  const int width = images.measured.width(), height = images.measured.height();
  Image<io::Rgb8> out(2 * width, 2 * height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::uint8_t grey = images.left(u, v);
      out(u, v) = {grey, grey, grey};
      out(width + u, v) = depth_color(static_cast<double>(images.depth(u, v)));
      out(u, height + v) = depth_color(0.001 * static_cast<double>(images.measured(u, v)));
      const bool is_point = images.measured(u, v) != 0;
      out(width + u, height + v) =
          is_point || labels.labels(u, v) != 0 ? label_colors[labels.labels(u, v)] : io::Rgb8{};
    }
  return out;
}

}  // namespace penumbra::study
