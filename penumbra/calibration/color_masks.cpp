// SPDX-License-Identifier: Apache-2.0
// Masks of the robot from colour images of a fixed camera.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/calibration/problem.hpp>

namespace penumbra::calibration {
namespace {

using Levels = std::array<float, 3>;  // of red, green and blue

Levels levels(const Rgb8& color, float brightness) {
  return {brightness * color.r, brightness * color.g, brightness * color.b};
}

/// Signed distances of an image's pixels from the robot's outline, up to `most`: positive outside.
Image<std::int16_t> distances(const VirtualDepthView& robot, int most) {
  const int width = robot.depth.width, height = robot.depth.height;
  const auto far = static_cast<std::int16_t>(most);
  Image<std::int16_t> out(width, height), in(width, height);
  std::fill_n(out.data(), out.size(), far);
  int left = width, right = 0, top = height, bottom = 0;  // of all that is nearer
  robot.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    left = std::min(left, u0 - most), right = std::max(right, u1 + most);
    top = std::min(top, v0 - most), bottom = std::max(bottom, v1 + most);
  });
  left = std::max(left, 0), right = std::min(right, width);
  top = std::max(top, 0), bottom = std::min(bottom, height);
  // The chessboard distance in two passes (Rosenfeld and Pfaltz 1966).
  const auto relax = [&](Image<std::int16_t>& image, int u, int v, int step) {
    std::int16_t& here = image(u, v);
    for (const auto& [du, dv] : {std::pair{-step, 0}, {0, -step}, {-step, -step}, {step, -step}}) {
      const int x = u + du, y = v + dv;
      if (x >= 0 && y >= 0 && x < width && y < height)
        here = std::min<std::int16_t>(here, static_cast<std::int16_t>(image(x, y) + 1));
    }
  };
  for (int v = top; v < bottom; ++v)
    for (int u = left; u < right; ++u) {
      (robot.depth(u, v) > 0.0f ? out : in)(u, v) = 0;
      if (robot.depth(u, v) > 0.0f) in(u, v) = far;
      relax(out, u, v, 1);
      relax(in, u, v, 1);
    }
  for (int v = bottom - 1; v >= top; --v)
    for (int u = right - 1; u >= left; --u) {
      relax(out, u, v, -1);
      relax(in, u, v, -1);
    }
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] = static_cast<std::int16_t>(out.data()[i] - in.data()[i]);
  return out;
}

/// The mean colour of the robot's inner pixels near each pixel.
class InnerColors {
 public:
  /// `away`: distances from the outline; inner ones are farther inside than half the margin.
  InnerColors(const Image<Rgb8>& color, float brightness, const Image<std::int16_t>& away,
              int margin)
      : reach_(2 * margin / step),
        width_(color.width() / step),
        height_(color.height() / step),
        sums_(static_cast<std::size_t>((width_ + 1) * (height_ + 1))) {
    for (int v = 0; v < height_; ++v) {
      std::array<float, 4> row{};
      for (int u = 0; u < width_; ++u) {
        if (2 * away(u * step, v * step) < -margin) {
          const Levels own = levels(color(u * step, v * step), brightness);
          for (std::size_t c = 0; c < 3; ++c) row[c] += own[c];
          row[3] += 1.0f;
        }
        for (std::size_t c = 0; c < 4; ++c) at(u + 1, v + 1)[c] = at(u + 1, v)[c] + row[c];
      }
    }
  }

  /// Returns null if no inner pixel is near.
  [[nodiscard]] std::optional<Levels> near(int u, int v) const {
    u /= step, v /= step;
    const int u0 = std::clamp(u - reach_, 0, width_), u1 = std::clamp(u + reach_ + 1, 0, width_);
    const int v0 = std::clamp(v - reach_, 0, height_), v1 = std::clamp(v + reach_ + 1, 0, height_);
    const auto sum = [&](std::size_t c) {
      return at(u1, v1)[c] - at(u0, v1)[c] - at(u1, v0)[c] + at(u0, v0)[c];
    };
    const float count = sum(3);
    if (count < 0.5f) return std::nullopt;
    return Levels{sum(0) / count, sum(1) / count, sum(2) / count};
  }

 private:
  static constexpr int step = 4;  // pixels: every fourth is enough

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_ + 1) +
           static_cast<std::size_t>(u);
  }
  [[nodiscard]] std::array<float, 4>& at(int u, int v) { return sums_[index(u, v)]; }
  [[nodiscard]] const std::array<float, 4>& at(int u, int v) const { return sums_[index(u, v)]; }

  int reach_, width_, height_;
  std::vector<std::array<float, 4>> sums_;  // of red, green, blue and 1, above and to the left
};

/// What is seen at a pixel where no robot is.
struct Background {
  Levels color{}, sigma{};

  /// Returns how far a colour is from it: sigmas of the channel that differs most.
  [[nodiscard]] float away(const Levels& other) const {
    float most = 0.0f;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(other[c] - color[c]) / sigma[c]);
    return most;
  }
};

/// Reorders the values of each channel.
Background background_of(std::array<std::vector<float>, 3>& values) {
  constexpr float least_sigma = 4.0f;  // levels: noise, and an image that is a little blurred
  Background found;
  for (std::size_t c = 0; c < 3; ++c) {
    found.color[c] = detail::median(values[c]);
    for (float& value : values[c]) value = std::abs(value - found.color[c]);
    found.sigma[c] = std::max(least_sigma, static_cast<float>(detail::robust_sigma(values[c])));
  }
  return found;
}

}  // namespace

/// Where background and robot have the same colour nothing is known. The robot's colour is that of
/// its inner pixels nearby.
void mask_by_color(std::vector<KeptFrame>& frames, std::span<const SmallFrames::Small> small,
                   Observer& observer, const State& state, int part) {
  const int margin = frames.front().color.width() / part;
  constexpr float same = 2.5f, other = 5.0f;  // sigmas from the background
  std::vector<KeptFrame*> used;
  std::vector<Image<std::int16_t>> away;  // from the outline
  std::vector<InnerColors> inner;
  const auto color = [&](std::size_t k, int u, int v) {
    return levels(used[k]->color(u, v), small[k].brightness);
  };
  for (KeptFrame& frame : frames) {
    frame.mask = Image<std::uint8_t>(frame.color.width(), frame.color.height());
    std::fill_n(frame.mask.data(), frame.mask.size(), KeptFrame::not_known);
    if (used.size() == small.size() || small[used.size()].frame != &frame) continue;
    used.push_back(&frame);
    const Image<std::int16_t>& distance =
        away.emplace_back(distances(observer.render(frame, state), margin + 1));
    inner.emplace_back(frame.color, small[used.size() - 1].brightness, distance, margin);
  }
  std::array<std::vector<float>, 3> values;
  for (int v = 0; v < frames.front().mask.height(); ++v)
    for (int u = 0; u < frames.front().mask.width(); ++u) {
      for (auto& channel : values) channel.clear();
      for (std::size_t k = 0; k < used.size(); ++k)
        if (away[k](u, v) > margin)
          for (std::size_t c = 0; c < 3; ++c) values[c].push_back(color(k, u, v)[c]);
      if (values[0].size() < KeptFrames::least || values[0].size() == used.size()) continue;
      const Background background = background_of(values);
      if (background.color == Levels{}) continue;  // outside of what the lens shows
      for (std::size_t k = 0; k < used.size(); ++k) {
        const int distance = away[k](u, v);
        if (distance > margin) continue;
        const float differs = background.away(color(k, u, v));
        if (differs > other) used[k]->mask(u, v) = 255;
        if (differs >= same || distance < -margin) continue;
        const std::optional<Levels> robot = inner[k].near(u, v);
        if (!robot || background.away(*robot) > other) used[k]->mask(u, v) = 0;
      }
    }
}

Refined refine_by_color(std::vector<KeptFrame>& frames, const PoseSearch& search,
                        Observer& observer, const Unknowns& unknowns,
                        const Eigen::Isometry3d& start) {
  FramePointers used;
  for (const SmallFrames::Small& small : search.frames()) used.push_back(small.frame);
  Refined fit{.state = {.T_parent_camera = start, .joint_offsets = {}},
              .covariance = {},
              .link_residuals = {}};
  for (const int part : {narrow_part / 4, narrow_part / 2, narrow_part}) {
    mask_by_color(frames, search.frames(), observer, fit.state, part);
    fit = refine(observer, unknowns, used, fit.state);
  }
  mask_by_color(frames, search.frames(), observer, fit.state);
  return fit;
}

}  // namespace penumbra::calibration
