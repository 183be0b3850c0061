// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <penumbra/base/error.hpp>

#include <sim/depth_sensor.hpp>
#include <sim/random.hpp>

namespace penumbra::sim {
namespace {

constexpr double edge_step = 0.04;   // relative step of depth that counts as an edge
constexpr int patch = 8;             // pixels, about the size of a matching window
constexpr double patch_share = 0.5;  // fraction of the noise's variance that a patch shares

/// Returns an approximately normal number from 64 random bits: the sum of four uniform numbers
/// (Irwin-Hall), mean 0, variance 1.
float normal_of(std::uint64_t bits) {
  const auto part = [&](int k) { return static_cast<float>((bits >> (16 * k)) & 0xFFFFU); };
  constexpr float middle = 2.0F * 65535.0F, to_unit = 1.7320508F / 65536.0F;
  return (part(0) + part(1) + part(2) + part(3) - middle) * to_unit;
}

void check_share(double share, const char* name) {
  if (!(share >= 0.0 && share <= 1.0))
    throw InputError(std::string("depth noise: ") + name + " is " + std::to_string(share) +
                     "; a share from 0 to 1 is needed");
}

}  // namespace

DepthSensor::DepthSensor(const DepthNoise& noise, double fx, std::uint64_t seed,
                         std::uint64_t stream)
    : noise_(noise), focal_baseline_(fx * noise.baseline), seed_(seed), stream_(stream) {
  check_share(noise.edge_holes, "edge_holes");
  check_share(noise.edge_mixed, "edge_mixed");
  check_share(noise.edge_holes + noise.edge_mixed, "edge_holes + edge_mixed");
  check_share(noise.holes, "holes");
  if (!(noise.quadratic >= 0.0 && noise.quadratic < 1.0 && noise.disparity_step >= 0.0 &&
        noise.disparity_step < 1e3 && noise.baseline > 0.0 && noise.edge_width >= 0.0 &&
        noise.edge_width <= 20.0))
    throw InputError(
        "depth noise: 0 <= quadratic < 1, 0 <= disparity_step, 0 < baseline and 0 <= edge_width "
        "<= 20 are needed");
}

/// Finds the nearest and farthest depth around each pixel: rows first, then columns.
void DepthSensor::find_sides(const Image<float>& truth) {
  const int width = truth.width(), height = truth.height();
  const int reach = static_cast<int>(std::ceil(noise_.edge_width));
  for (auto* buffer : {&near_, &far_, &rows_near_, &rows_far_}) buffer->resize(truth.size());
  const auto at = [&](int v) { return static_cast<std::ptrdiff_t>(v) * width; };
  for (int v = 0; v < height; ++v) {
    const float* const z = truth.view().row(v);
    float *const low = &rows_near_[0] + at(v), *const high = &rows_far_[0] + at(v);
    std::copy(z, z + width, low);
    std::copy(z, z + width, high);
    for (int k = 1; k <= std::min(reach, width - 1); ++k) {
      for (int u = 0; u < width - k; ++u) {
        low[u] = std::min(low[u], z[u + k]);
        high[u] = std::max(high[u], z[u + k]);
      }
      for (int u = k; u < width; ++u) {
        low[u] = std::min(low[u], z[u - k]);
        high[u] = std::max(high[u], z[u - k]);
      }
    }
  }
  near_ = rows_near_;
  far_ = rows_far_;
  for (int v = 0; v < height; ++v)
    for (int k = -reach; k <= reach; ++k) {
      if (k == 0 || v + k < 0 || v + k >= height) continue;
      const float *const low = &rows_near_[0] + at(v + k), *const high = &rows_far_[0] + at(v + k);
      float *const near = &near_[0] + at(v), *const far = &far_[0] + at(v);
      for (int u = 0; u < width; ++u) {
        near[u] = std::min(near[u], low[u]);
        far[u] = std::max(far[u], high[u]);
      }
    }
}

void DepthSensor::draw_patches(int width, int height, std::uint64_t frame) {
  const int columns = width / patch + 2, rows = height / patch + 2;
  Random random(seed_, mix(stream_ ^ (frame << 8)) ^ 1U);
  lattice_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (float& value : lattice_) value = normal_of(random.bits());
}

std::uint16_t DepthSensor::quantised(double z) const {
  if (noise_.disparity_step > 0.0) {
    const double steps = std::round(focal_baseline_ / z / noise_.disparity_step);
    if (!(steps >= 1.0)) return 0;
    z = focal_baseline_ / (steps * noise_.disparity_step);
  }
  const double millimetres = std::round(1000.0 * z);
  return millimetres >= 1.0 && millimetres <= 65535.0 ? static_cast<std::uint16_t>(millimetres) : 0;
}

/// Adds discs without measurement until they cover the requested fraction.
void DepthSensor::cut_holes(std::uint64_t frame, Image<std::uint16_t>& measured) const {
  Random random(seed_, mix(stream_ ^ (frame << 8)) ^ 2U);
  constexpr double least = 1.5, most = 6.0;  // pixels, radius
  constexpr double mean_area = 3.141592653589793 * (least * least + least * most + most * most) / 3;
  const auto count = static_cast<int>(std::floor(
      noise_.holes * static_cast<double>(measured.size()) / mean_area + random.uniform()));
  for (int i = 0; i < count; ++i) {
    const double u0 = random.uniform(0.0, measured.width()),
                 v0 = random.uniform(0.0, measured.height()), radius = random.uniform(least, most);
    for (int v = static_cast<int>(v0 - radius); v <= static_cast<int>(v0 + radius); ++v)
      for (int u = static_cast<int>(u0 - radius); u <= static_cast<int>(u0 + radius); ++u)
        if (u >= 0 && v >= 0 && u < measured.width() && v < measured.height() &&
            (u - u0) * (u - u0) + (v - v0) * (v - v0) <= radius * radius)
          measured(u, v) = 0;
  }
}

void DepthSensor::measure(const Image<float>& truth, std::uint64_t frame,
                          Image<std::uint16_t>& measured) {
  const int width = truth.width(), height = truth.height();
  measured.fit(width, height);
  const double edges = noise_.edge_holes + noise_.edge_mixed;
  const bool has_edges = edges > 0.0 && noise_.edge_width > 0.0;
  if (has_edges) find_sides(truth);
  draw_patches(width, height, frame);
  const int columns = width / patch + 2;
  const std::uint64_t base = mix(seed_ ^ mix(stream_ ^ (frame << 8)));
  std::size_t i = 0;
  for (int v = 0; v < height; ++v) {
    const float t = (static_cast<float>(v % patch) + 0.5F) / patch;
    for (int u = 0; u < width; ++u, ++i) {
      const double z = static_cast<double>(truth.data()[i]);
      std::uint16_t& out = measured.data()[i];
      out = 0;
      if (!(z > 0.0)) continue;
      const std::uint64_t bits = mix(base + i);
      if (has_edges && far_[i] > near_[i] * static_cast<float>(1.0 + edge_step)) {
        const double luck = static_cast<double>(mix(bits) >> 11) * 0x1p-53;
        if (luck < noise_.edge_holes) continue;
        if (luck < edges && near_[i] > 0.0F) {
          // A matching window that sees both sides gives a disparity between them.
          const double between = (luck - noise_.edge_holes) / std::max(noise_.edge_mixed, 1e-9);
          out = quantised(1.0 / std::lerp(1.0 / static_cast<double>(near_[i]),
                                          1.0 / static_cast<double>(far_[i]), between));
          continue;
        }
      }
      const float s = (static_cast<float>(u % patch) + 0.5F) / patch;
      const float* const corner = lattice_.data() + v / patch * columns + u / patch;
      const float shared = (1 - t) * ((1 - s) * corner[0] + s * corner[1]) +
                           t * ((1 - s) * corner[columns] + s * corner[columns + 1]);
      const float variance = ((1 - t) * (1 - t) + t * t) * ((1 - s) * (1 - s) + s * s);
      const float error = std::sqrt(static_cast<float>(patch_share) / variance) * shared +
                          std::sqrt(static_cast<float>(1.0 - patch_share)) * normal_of(bits);
      out = quantised(z + noise_.quadratic * z * z * static_cast<double>(error));
    }
  }
  cut_holes(frame, measured);
}

}  // namespace penumbra::sim
