// SPDX-License-Identifier: Apache-2.0
// Colour images of a fixed camera: a pixel's background is seen in the frames in which the robot is
// elsewhere, and what the robot covers differs from it.
#include <algorithm>
#include <cmath>

#include <penumbra/calibration/problem.hpp>

namespace penumbra::calibration {
namespace {

// Costs of a pixel in one frame, as negative logarithms of likelihoods.
constexpr float noise = 8.0f;       // grey levels of a bare pixel
constexpr float surprise = 8.0f;    // a bare pixel of any other colour
constexpr float any_color = 3.0f;   // a covered one, which may have any colour
constexpr float never_bare = 1.0f;  // one whose background no frame shows
constexpr int rounds = 2;           // of the robust mean that is the background

}  // namespace

ColorScore::ColorScore(SmallFrames& frames) : frames_(frames) {
  const std::vector<SmallFrames::Small>& all = frames.frames();
  const int width = frames.camera().width(), height = frames.camera().height();
  still_ = seen_ = Image<float>(width, height);
  bare_.assign(all.size(), seen_);
  all_bare_.assign(static_cast<std::size_t>(width), 1.0f);
  sums_.fill(std::vector<float>(static_cast<std::size_t>(width)));
  for (std::size_t i = 0; i < seen_.size(); ++i)
    for (const SmallFrames::Small& small : all)
      if (small.grey.data()[i] > 0.0f) seen_.data()[i] = 1.0f;
}

/// Of the pixels first <= u < end of a row, into sums_[2]. Loops over pixels are the inner ones:
/// the compiler makes vectors of them.
void ColorScore::find_costs(int v, int first, int end, bool is_still) {
  const std::vector<SmallFrames::Small>& frames = frames_.frames();
  const auto for_each_frame = [&](auto&& f) {
    for (std::size_t k = 0; k < frames.size(); k += every_frame_)
      f(&frames[k].grey(0, v), is_still ? all_bare_.data() : &bare_[k](0, v));
  };
  float* const mean = sums_[0].data();
  float* const weights = sums_[1].data();
  float* const cost = sums_[2].data();
  float* const sum = sums_[3].data();
  float all = 0.0f;
  for (int round = 0; round <= rounds; ++round) {
    std::fill(weights, weights + end, 0.0f);
    std::fill(sum, sum + end, 0.0f);
    const float narrow = round == 0 ? 0.0f : 1.0f / (noise * noise);  // Cauchy's weight
    for_each_frame([&](const float* grey, const float* bare) {
      for (int u = first; u < end; ++u) {
        const float away = grey[u] - mean[u];
        const float weight = bare[u] / (1.0f + narrow * away * away);
        weights[u] += weight;
        sum[u] += weight * grey[u];
      }
    });
    for (int u = first; u < end; ++u) mean[u] = sum[u] / std::max(weights[u], 1e-6f);
  }
  std::fill(cost, cost + end, 0.0f);
  const float covered = static_cast<float>(covering_) * any_color;
  for_each_frame([&](const float* grey, const float* bare) {
    all += static_cast<float>(covering_) * never_bare;
    for (int u = first; u < end; ++u) {
      const float away = (grey[u] - mean[u]) / noise;
      cost[u] += bare[u] * std::min(0.5f * away * away, surprise) + (1.0f - bare[u]) * covered;
    }
  });
  const float* const seen = &seen_(0, v);
  for (int u = first; u < end; ++u) cost[u] = seen[u] * (weights[u] > 0.0f ? cost[u] : all);
}

double ColorScore::score(
    const std::function<std::vector<Eigen::Isometry3d>(std::size_t)>& T_camera_link,
    std::size_t every_frame, double covering) {
  const int width = still_.width(), height = still_.height();
  covering_ = covering;
  if (every_frame_ != every_frame) {
    every_frame_ = every_frame;
    explainable_ = 1.0;
    for (int v = 0; v < height; ++v) {
      find_costs(v, 0, width, true);
      std::copy(sums_[2].begin(), sums_[2].end(), &still_(0, v));
      for (const float cost : sums_[2]) explainable_ += cost;
    }
  }
  TileMask touched(width, height);
  for (std::size_t k = 0; k < bare_.size(); k += every_frame) {
    const VirtualDepthView robot = frames_.render(T_camera_link(k));
    for (std::size_t j = 0; j < touched.rows.size(); ++j) touched.rows[j] |= robot.touched->rows[j];
    for (int v = 0; v < height; ++v) {
      const float* const rendered = robot.depth.row(v);
      float* const bare = &bare_[k](0, v);
      for (int u = 0; u < width; ++u) bare[u] = rendered[u] > 0.0f ? 0.0f : 1.0f;
    }
  }
  double explained = 0.0;
  touched.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) {
      find_costs(v, u0, u1, false);
      float sum = 0.0f;
      for (int u = u0; u < u1; ++u) sum += still_(u, v) - sums_[2][static_cast<std::size_t>(u)];
      explained += sum;
    }
  });
  return explained / explainable_;
}

}  // namespace penumbra::calibration
