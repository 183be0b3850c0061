// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include <penumbra/camera/registration.hpp>

namespace penumbra {
namespace {

constexpr auto unreachable = std::numeric_limits<float>::quiet_NaN();

/// Footprints of neighbours meet but for rounding, and where the image of a square is none.
constexpr float footprint_overlap = 1.0F / 16;  // pixels

float metres_of(std::uint16_t millimetres) { return 1e-3F * static_cast<float>(millimetres); }
float metres_of(float metres) { return metres; }

/// 0 where the kind has no number for it.
void store_depth(float metres, std::uint16_t& to) {
  const float rounded = 1e3F * metres + 0.5F;
  to = rounded < 65536.0F ? static_cast<std::uint16_t>(rounded) : std::uint16_t{0};
}
void store_depth(float metres, float& to) { to = metres; }

/// The first pixel whose centre is not before x, from 0 to `size`.
int first_pixel(float x, int size) {
  const float inside = std::clamp(x, 0.0F, static_cast<float>(size));
  const int below = static_cast<int>(inside);
  return below + (static_cast<float>(below) < inside ? 1 : 0);
}

Camera checked_camera(const Camera& camera) {
  camera.check();
  return camera;
}

}  // namespace

DepthRegistration::DepthRegistration(const Camera& from, const Camera& to)
    : from_(checked_camera(from)),
      to_(checked_camera(to)),
      rays_(from.intrinsics.width() + 2, from.intrinsics.height() + 2) {
  for (int v = 0; v < rays_.height(); ++v) {
    for (int u = 0; u < rays_.width(); ++u) {
      const auto point = from_.distortion.undistort(from_.intrinsics.ray(u - 1, v - 1).head<2>());
      const Eigen::Vector2f xy =
          point ? Eigen::Vector2f(point->cast<float>()) : Eigen::Vector2f::Constant(unreachable);
      rays_(u, v) = {xy.x(), xy.y()};
    }
  }
  rows_.fill(Row(static_cast<std::size_t>(rays_.width())));
}

DepthView DepthRegistration::warp(const DepthView& depth, const Eigen::Isometry3d& T_to_from) {
  rotation_ = T_to_from.linear().cast<float>();
  translation_ = T_to_from.translation().cast<float>();
  if (const auto* millimetres = std::get_if<ImageView<const std::uint16_t>>(&depth))
    return warp_into(millimetres_, *millimetres);
  return warp_into(metres_, std::get<ImageView<const float>>(depth));
}

template <typename T>
DepthView DepthRegistration::warp_into(Image<T>& out, ImageView<const T> depth) {
  const int width = from_.intrinsics.width();
  const int height = from_.intrinsics.height();
  if (depth.width != width || depth.height != height)
    throw std::invalid_argument("DepthRegistration: the depth image has not the camera's size");
  if (out.empty()) out = Image<T>(to_.intrinsics.width(), to_.intrinsics.height());
  std::fill(out.data(), out.data() + out.size(), T{0});
  land_row(depth, -1, rows_[1]);
  land_row(depth, 0, rows_[2]);
  for (int v = 0; v < height; ++v) {
    std::rotate(rows_.begin(), rows_.begin() + 1, rows_.end());
    land_row(depth, v + 1, rows_[2]);
    for (int u = 0; u < width; ++u) {
      const Landing& own = rows_[1][static_cast<std::size_t>(u) + 1];
      if (own.depth <= 0.0F) continue;
      T value{};
      store_depth(own.z, value);
      if (value == T{0}) continue;
      const Box box = footprint(u, v);
      for (int y = box.v0; y < box.v1; ++y)
        for (T* pixel = out.view().row(y) + box.u0; pixel < out.view().row(y) + box.u1; ++pixel)
          if (*pixel == T{0} || value < *pixel) *pixel = value;
    }
  }
  return ImageView<const T>(out.view());
}

template <typename T>
void DepthRegistration::land_row(ImageView<const T> image, int v, Row& row) const {
  if (v < 0 || v >= image.height) {
    std::fill(row.begin(), row.end(), Landing{});
    return;
  }
  const auto near = static_cast<float>(std::max(from_.range.near, min_depth));
  const auto far = static_cast<float>(std::min(from_.range.far, max_depth));
  for (int u = 0; u < image.width; ++u) {
    const float depth = metres_of(image(u, v));
    const bool measured = depth >= near && depth <= far;
    row[static_cast<std::size_t>(u) + 1] = measured ? land(ray(u, v), depth) : Landing{};
  }
}

DepthRegistration::Landing DepthRegistration::land(const Ray& ray, float depth) const {
  const Eigen::Vector3f p =
      rotation_ * Eigen::Vector3f(ray.x * depth, ray.y * depth, depth) + translation_;
  if (!(p.z() >= static_cast<float>(min_depth) && p.z() <= static_cast<float>(max_depth)))
    return {};
  float x = p.x() / p.z();
  float y = p.y() / p.z();
  if (!std::isfinite(x + y)) return {};
  if (!to_.distortion.is_none()) {
    const Eigen::Vector2d point(x, y);
    if (!(point.norm() < to_.distortion.max_radius())) return {};
    const Eigen::Vector2d bent = to_.distortion.distort(point);
    x = static_cast<float>(bent.x());
    y = static_cast<float>(bent.y());
  }
  const Intrinsics& k = to_.intrinsics;
  return {static_cast<float>(k.fx()) * x + static_cast<float>(k.cx()),
          static_cast<float>(k.fy()) * y + static_cast<float>(k.cy()), p.z(), depth};
}

Eigen::Vector2f DepthRegistration::half_way(const Landing& own, const Landing& other,
                                            const Ray& other_ray, float slope) const {
  const float nearer = std::min(own.depth, other.depth);
  const bool one_surface = nearer > 0.0F && std::abs(own.depth - other.depth) <= slope * nearer;
  // A neighbour of another surface stands for where this one would go on.
  const Landing end = one_surface ? other : land(other_ray, own.depth);
  if (end.depth <= 0.0F) return Eigen::Vector2f::Zero();
  return {0.5F * (end.u - own.u), 0.5F * (end.v - own.v)};
}

DepthRegistration::Box DepthRegistration::footprint(int u, int v) const {
  const auto i = static_cast<std::size_t>(u) + 1;
  const Landing& own = rows_[1][i];
  const auto slope_u = static_cast<float>(max_slope / from_.intrinsics.fx());
  const auto slope_v = static_cast<float>(max_slope / from_.intrinsics.fy());
  const Eigen::Vector2f left = half_way(own, rows_[1][i - 1], ray(u - 1, v), slope_u);
  const Eigen::Vector2f right = half_way(own, rows_[1][i + 1], ray(u + 1, v), slope_u);
  const Eigen::Vector2f above = half_way(own, rows_[0][i], ray(u, v - 1), slope_v);
  const Eigen::Vector2f below = half_way(own, rows_[2][i], ray(u, v + 1), slope_v);
  const Eigen::Array2f low = left.array().min(right.array()) + above.array().min(below.array());
  const Eigen::Array2f high = left.array().max(right.array()) + above.array().max(below.array());
  constexpr auto reach = static_cast<float>(max_reach);
  const Eigen::Array2f own_at(own.u, own.v);
  const Eigen::Array2f begin = own_at + (low - footprint_overlap).max(-reach);
  const Eigen::Array2f end = own_at + (high + footprint_overlap).min(reach);
  return {first_pixel(begin.x(), to_.intrinsics.width()),
          first_pixel(end.x(), to_.intrinsics.width()),
          first_pixel(begin.y(), to_.intrinsics.height()),
          first_pixel(end.y(), to_.intrinsics.height())};
}

}  // namespace penumbra
