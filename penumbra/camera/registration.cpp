// SPDX-License-Identifier: Apache-2.0
// Loops over blocks have a fixed length and no branches, so that compilers vectorise them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/camera/registration.hpp>

namespace penumbra {
namespace {

/// a && b without a branch.
constexpr bool both(bool a, bool b) { return (static_cast<int>(a) & static_cast<int>(b)) != 0; }

constexpr auto unreachable = std::numeric_limits<float>::quiet_NaN();

/// Closes gaps between footprints of neighbours, due to rounding and perspective.
constexpr float footprint_overlap = 1.0F / 16;  // pixels

/// Pixels; images are at most half as large.
constexpr float farthest_pixel = 65536.0F;

constexpr auto nearest_z = static_cast<float>(DepthRegistration::min_depth);
constexpr auto farthest_z = static_cast<float>(DepthRegistration::max_depth);

/// Larger than every depth.
template <typename T>
constexpr T unseen = std::numeric_limits<T>::max();

/// Stores 0 if the type cannot hold the depth.
void store_depth(float metres, std::uint16_t& to) {
  const float rounded = 1e3F * metres + 0.5F;
  to = rounded < 65535.0F ? static_cast<std::uint16_t>(rounded) : std::uint16_t{0};
}
void store_depth(float metres, float& to) { to = metres; }

/// Returns the first pixel whose centre is at least x, from 0 to `size`.
inline int first_pixel(float x, float size) {
  const float inside = std::min(std::max(0.0F, x), size);  // 0 for NaN
  const int below = static_cast<int>(inside);
  return below + (static_cast<float>(below) < inside ? 1 : 0);
}

/// Writes the corners without a branch: most footprints have at most 2 x 2 pixels.
template <typename Box, typename T>
void splat(const Box& box, T depth, ImageView<T> out) {
  const auto put = [&](T& pixel) { pixel = depth < pixel ? depth : pixel; };
  T* const top = out.row(box.v0);
  T* const bottom = out.row(box.v1 - 1);
  put(top[box.u0]);
  put(top[box.u1 - 1]);
  put(bottom[box.u0]);
  put(bottom[box.u1 - 1]);
  if (box.u1 - box.u0 <= 2 && box.v1 - box.v0 <= 2) return;
  for (int v = box.v0; v < box.v1; ++v)
    for (int u = box.u0; u < box.u1; ++u) put(out.row(v)[u]);
}

}  // namespace

DepthRegistration::DepthRegistration(const Camera& from, const Camera& to)
    : from_(from.check()),
      to_(to.check()),
      range_(std::max(from.range.near, min_depth), std::min(from.range.far, max_depth)),
      rays_x_(from.intrinsics.width() + 2 + block, from.intrinsics.height() + 2, unreachable),
      rays_y_(rays_x_),
      slope_u_(static_cast<float>(max_slope / from.intrinsics.fx())),
      slope_v_(static_cast<float>(max_slope / from.intrinsics.fy())),
      focal_(Eigen::Vector2d(to.intrinsics.fx(), to.intrinsics.fy()).cast<float>()),
      centre_(Eigen::Vector2d(to.intrinsics.cx(), to.intrinsics.cy()).cast<float>()) {
  for (int v = 0; v < from.intrinsics.height() + 2; ++v) {
    for (int u = 0; u < from.intrinsics.width() + 2; ++u) {
      const auto point = from_.distortion.undistort(from_.intrinsics.ray(u - 1, v - 1).head<2>());
      if (!point) continue;
      rays_x_(u, v) = static_cast<float>(point->x());
      rays_y_(u, v) = static_cast<float>(point->y());
    }
  }
  for (Row& row : rows_)
    row.u = row.v = row.z = row.depth =
        std::vector<float>(static_cast<std::size_t>(rays_x_.width()));
}

DepthView DepthRegistration::warp(const DepthView& depth, const Eigen::Isometry3d& T_to_from) {
  if (!is_rigid(T_to_from))
    throw InputError("T_to_from: expected a finite rotation (to 1e-4) and translation");
  rotation_ = T_to_from.linear().cast<float>();
  translation_ = T_to_from.translation().cast<float>();
  if (const auto* millimetres = std::get_if<ImageView<const std::uint16_t>>(&depth))
    return warp_into(millimetres_, *millimetres);
  return warp_into(metres_, std::get<ImageView<const float>>(depth));
}

template <typename T>
DepthView DepthRegistration::warp_into(Image<T>& out, ImageView<const T> depth) {
  if (depth.width != from_.intrinsics.width() || depth.height != from_.intrinsics.height())
    throw std::invalid_argument(
        "DepthRegistration: the depth image must have the size of the camera's image");
  if (out.empty()) out = Image<T>(to_.intrinsics.width(), to_.intrinsics.height());
  T* const end = out.data() + out.size();
  std::fill(out.data(), end, unseen<T>);
  land_row(depth, -1, rows_[1]);
  land_row(depth, 0, rows_[2]);
  for (int v = 0; v < depth.height; ++v) {
    std::rotate(rows_.begin(), rows_.begin() + 1, rows_.end());
    land_row(depth, v + 1, rows_[2]);
    splat_row(v, out);
  }
  std::replace(out.data(), end, unseen<T>, T{0});
  return ImageView<const T>(out.view());
}

template <typename T>
void DepthRegistration::land_row(ImageView<const T> image, int v, Row& row) const {
  if (v < 0 || v >= image.height) {
    std::fill(row.depth.begin(), row.depth.end(), 0.0F);
    return;
  }
  for (int u = 0; u < image.width; u += block) {
    std::array<T, block> given{};
    std::copy_n(image.row(v) + u, std::min(block, image.width - u), given.begin());
    std::array<float, block> depth;
    for (std::size_t i = 0; i < block; ++i) depth[i] = metres_of(given[i], range_);
    land_block(depth.data(), u, v, row);
    if (!to_.distortion.is_none()) bend_block(u, row);
    keep_landed(depth.data(), u, row);
  }
}

// Writes points on the plane z = 1 of `to`.
void DepthRegistration::land_block(const float* depth, int u, int v, Row& row) const {
  const float* const rays_x = &rays_x_(u + 1, v + 1);
  const float* const rays_y = &rays_y_(u + 1, v + 1);
  float* const to_u = &row.u[static_cast<std::size_t>(u) + 1];
  float* const to_v = &row.v[static_cast<std::size_t>(u) + 1];
  float* const to_z = &row.z[static_cast<std::size_t>(u) + 1];
  const Eigen::Matrix3f R = rotation_;
  const Eigen::Vector3f t = translation_;
  std::array<float, block> x, y, z;
  for (std::size_t i = 0; i < block; ++i) {
    const float px = rays_x[i] * depth[i];
    const float py = rays_y[i] * depth[i];
    z[i] = R(2, 0) * px + R(2, 1) * py + R(2, 2) * depth[i] + t[2];
    x[i] = (R(0, 0) * px + R(0, 1) * py + R(0, 2) * depth[i] + t[0]) / z[i];
    y[i] = (R(1, 0) * px + R(1, 1) * py + R(1, 2) * depth[i] + t[1]) / z[i];
  }
  std::copy(x.begin(), x.end(), to_u);
  std::copy(y.begin(), y.end(), to_v);
  std::copy(z.begin(), z.end(), to_z);
}

void DepthRegistration::bend_block(int u, Row& row) const {
  for (std::size_t i = static_cast<std::size_t>(u) + 1; i < static_cast<std::size_t>(u) + 1 + block;
       ++i) {
    const Eigen::Vector2d point(row.u[i], row.v[i]);
    const bool reached = point.norm() < to_.distortion.max_radius();
    const Eigen::Vector2d bent = reached ? to_.distortion.distort(point) : point * unreachable;
    row.u[i] = static_cast<float>(bent.x());
    row.v[i] = static_cast<float>(bent.y());
  }
}

// Drops points far outside of the image and rays that a lens does not reach (NaN).
void DepthRegistration::keep_landed(const float* depth, int u, Row& row) const {
  float* const to_u = &row.u[static_cast<std::size_t>(u) + 1];
  float* const to_v = &row.v[static_cast<std::size_t>(u) + 1];
  const float* const to_z = &row.z[static_cast<std::size_t>(u) + 1];
  float* const to_depth = &row.depth[static_cast<std::size_t>(u) + 1];
  std::array<float, block> pixel_u, pixel_v, kept;
  for (std::size_t i = 0; i < block; ++i) {
    pixel_u[i] = focal_.x() * to_u[i] + centre_.x();
    pixel_v[i] = focal_.y() * to_v[i] + centre_.y();
    const bool lands =
        both(both(to_z[i] >= nearest_z, to_z[i] <= farthest_z),
             both(std::abs(pixel_u[i]) < farthest_pixel, std::abs(pixel_v[i]) < farthest_pixel));
    kept[i] = lands ? depth[i] : 0.0F;
  }
  std::copy(pixel_u.begin(), pixel_u.end(), to_u);
  std::copy(pixel_v.begin(), pixel_v.end(), to_v);
  std::copy(kept.begin(), kept.end(), to_depth);
}

DepthRegistration::Landing DepthRegistration::land(const Ray& ray, float depth) const {
  const Eigen::Vector3f p =
      rotation_ * Eigen::Vector3f(ray.x * depth, ray.y * depth, depth) + translation_;
  if (!(p.z() >= nearest_z && p.z() <= farthest_z)) return {};
  Eigen::Vector2f at = p.head<2>() / p.z();
  if (!to_.distortion.is_none()) {
    const Eigen::Vector2d point = at.cast<double>();
    if (!(point.norm() < to_.distortion.max_radius())) return {};
    at = to_.distortion.distort(point).cast<float>();
  }
  at = focal_.cwiseProduct(at) + centre_;
  if (!(at.cwiseAbs().maxCoeff() < farthest_pixel)) return {};
  return {at.x(), at.y(), p.z(), depth};
}

template <typename T>
void DepthRegistration::splat_row(int v, Image<T>& out) const {
  const int width = from_.intrinsics.width();
  for (int first = 0; first < width; first += block) {
    const Footprints all = footprints(first);
    for (int u = first; u < std::min(first + block, width); ++u) {
      const auto i = static_cast<std::size_t>(u - first);
      const auto at = static_cast<std::size_t>(u) + 1;
      if (rows_[1].depth[at] <= 0.0F) continue;
      const Box box = all.is_valid[i] != 0 ? Box{all.u0[i], all.u1[i], all.v0[i], all.v1[i]}
                                           : footprint_at_edge(u, v);
      T depth{};
      store_depth(rows_[1].z[at], depth);
      if (depth != T{0} && box.u0 < box.u1 && box.v0 < box.v1) splat(box, depth, out.view());
    }
  }
}

DepthRegistration::Footprints DepthRegistration::footprints(int u) const {
  const auto at = static_cast<std::size_t>(u) + 1;
  const float* const depth = &rows_[1].depth[at];
  const auto width = static_cast<float>(to_.intrinsics.width());
  const auto height = static_cast<float>(to_.intrinsics.height());
  constexpr auto reach = static_cast<float>(max_reach);
  Footprints out;
  // Half-way to the neighbours.
  const auto spans = [&](const float* own, const float* above, const float* below, float size,
                         std::array<int, block>& begin, std::array<int, block>& end) {
    for (std::size_t i = 0; i < block; ++i) {
      const float left = own[static_cast<std::ptrdiff_t>(i) - 1];
      const float right = own[i + 1];
      const float low = 0.5F * (std::min(left, right) + std::min(above[i], below[i]));
      const float high = 0.5F * (std::max(left, right) + std::max(above[i], below[i]));
      begin[i] = first_pixel(std::max(low - footprint_overlap, own[i] - reach), size);
      end[i] = first_pixel(std::min(high + footprint_overlap, own[i] + reach), size);
    }
  };
  spans(&rows_[1].u[at], &rows_[0].u[at], &rows_[2].u[at], width, out.u0, out.u1);
  spans(&rows_[1].v[at], &rows_[0].v[at], &rows_[2].v[at], height, out.v0, out.v1);
  const float* const above = &rows_[0].depth[at];
  const float* const below = &rows_[2].depth[at];
  for (std::size_t i = 0; i < block; ++i) {
    const float before = std::abs(depth[static_cast<std::ptrdiff_t>(i) - 1] - depth[i]);
    const float after = std::abs(depth[i + 1] - depth[i]);
    const float up = std::abs(above[i] - depth[i]);
    const float down = std::abs(below[i] - depth[i]);
    out.is_valid[i] = both(std::max(before, after) <= slope_u_ * depth[i],
                           std::max(up, down) <= slope_v_ * depth[i]);
  }
  return out;
}

DepthRegistration::Box DepthRegistration::footprint_at_edge(int u, int v) const {
  const auto i = static_cast<std::size_t>(u) + 1;
  const Landing own = rows_[1][i];
  const Eigen::Vector2f left = half_way(own, rows_[1][i - 1], ray(u - 1, v), slope_u_);
  const Eigen::Vector2f right = half_way(own, rows_[1][i + 1], ray(u + 1, v), slope_u_);
  const Eigen::Vector2f above = half_way(own, rows_[0][i], ray(u, v - 1), slope_v_);
  const Eigen::Vector2f below = half_way(own, rows_[2][i], ray(u, v + 1), slope_v_);
  const Eigen::Vector2f low = left.cwiseMin(right) + above.cwiseMin(below);
  const Eigen::Vector2f high = left.cwiseMax(right) + above.cwiseMax(below);
  const auto width = static_cast<float>(to_.intrinsics.width());
  const auto height = static_cast<float>(to_.intrinsics.height());
  constexpr auto reach = static_cast<float>(max_reach);
  return {first_pixel(std::max(own.u + low.x() - footprint_overlap, own.u - reach), width),
          first_pixel(std::min(own.u + high.x() + footprint_overlap, own.u + reach), width),
          first_pixel(std::max(own.v + low.y() - footprint_overlap, own.v - reach), height),
          first_pixel(std::min(own.v + high.y() + footprint_overlap, own.v + reach), height)};
}

Eigen::Vector2f DepthRegistration::half_way(const Landing& own, const Landing& other,
                                            const Ray& other_ray, float slope) const {
  const bool one_surface =
      other.depth > 0.0F && std::abs(own.depth - other.depth) <= slope * own.depth;
  // Where this surface would continue behind a neighbour on another surface.
  const Landing end = one_surface ? other : land(other_ray, own.depth);
  if (end.depth <= 0.0F) return Eigen::Vector2f::Zero();
  return {0.5F * (end.u - own.u), 0.5F * (end.v - own.v)};
}

}  // namespace penumbra
