// SPDX-License-Identifier: Apache-2.0
#include "measured_paste.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::test {
namespace {

constexpr int patches_size = 512;

/// White noise smoothed by a Gaussian, wrapping around, brought to spread 1.
Image<float> gaussian_patches(double sigma, std::mt19937_64& random) {
  std::normal_distribution<float> normal;
  Image<float> image(patches_size, patches_size), smooth(patches_size, patches_size);
  std::generate_n(image.data(), image.size(), [&] { return normal(random); });
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  for (const bool across : {true, false}) {
    for (int v = 0; v < patches_size; ++v) {
      for (int u = 0; u < patches_size; ++u) {
        double sum = 0.0;
        for (int i = -reach; i <= reach; ++i) {
          const double weight = std::exp(-0.5 * i * i / (sigma * sigma));
          const int x = (u + (across ? i : 0)) & (patches_size - 1);
          const int y = (v + (across ? 0 : i)) & (patches_size - 1);
          sum += weight * static_cast<double>(image(x, y));
        }
        smooth(u, v) = static_cast<float>(sum);
      }
    }
    std::swap(image, smooth);
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i)
    squares += static_cast<double>(image.data()[i]) * static_cast<double>(image.data()[i]);
  const auto spread = static_cast<float>(std::sqrt(squares / static_cast<double>(image.size())));
  std::for_each(image.data(), image.data() + image.size(), [&](float& x) { x /= spread; });
  return image;
}

}  // namespace

MeasuredPaste::MeasuredPaste(const SensorModel& model, std::mt19937_64::result_type seed)
    : model_(model), random_(seed), patches_(gaussian_patches(model.patch_sigma, random_)) {}

double MeasuredPaste::noise(double z, int u, int v) {
  const auto patch = static_cast<double>(
      patches_((u + shift_u_) & (patches_size - 1), (v + shift_v_) & (patches_size - 1)));
  const double white = std::normal_distribution<double>()(random_);
  return z * z * (model_.patchy * patch + model_.white * white);
}

void MeasuredPaste::begin() {
  on_robot_ = beside_ = {};
  before_.clear();
  shift_u_ = static_cast<int>(random_() % patches_size);
  shift_v_ = static_cast<int>(random_() % patches_size);
}

void MeasuredPaste::add(RealFrame& frame, const SurfaceHit& hit, int u, int v) {
  const double inside = hit.inside * frame.intrinsics.fx() / hit.depth;  // pixels
  if (!(inside > -model_.edge)) return;
  const double object = hit.depth + noise(hit.depth, u, v);
  const double behind = 0.001 * static_cast<double>(frame.measured(u, v));
  const bool at_edge = inside < model_.edge;
  double z = inside > 0.0 ? object : behind;
  if (at_edge && behind > 0.0 && uniform(random_) < model_.mixed) {
    const double share = 0.5 + 0.5 * inside / model_.edge;
    z = share * object + (1.0 - share) * behind;
  }
  if (uniform(random_) < (at_edge ? model_.edge_holes : model_.inside_holes)) z = 0.0;
  const int pixel = v * frame.intrinsics.width() + u;
  before_.emplace_back(pixel, frame.measured(u, v));
  frame.measured(u, v) = static_cast<std::uint16_t>(std::lround(1000.0 * z));
  if (inside <= 0.0 || z == 0.0) return;
  Pixels& seen = frame.robot(u, v) > 0.0F ? on_robot_ : beside_;
  (at_edge ? seen.band : seen.core).push_back(pixel);
}

void MeasuredPaste::undo(RealFrame& frame) {
  for (const auto& [pixel, depth] : before_) frame.measured.data()[pixel] = depth;
  before_.clear();
}

}  // namespace penumbra::test
