// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include <penumbra/occlusion/labels.hpp>

#include <io/ros/image_codec.hpp>
#include <io/ros/result_messages.hpp>

namespace penumbra::io {
namespace {

constexpr std::uint32_t point_bytes = 3 * sizeof(float);
constexpr float no_ray = std::numeric_limits<float>::quiet_NaN();

bool is_trusted(std::uint8_t label) {
  return label == static_cast<std::uint8_t>(Label::clear) ||
         label == static_cast<std::uint8_t>(Label::front);
}

/// Metres; 0: no measurement.
float metres_of(std::uint16_t depth) {
  return depth == saturated_depth ? 0.0F : 0.001F * static_cast<float>(depth);
}
float metres_of(float depth) { return std::isfinite(depth) && depth > 0 ? depth : 0.0F; }

template <typename T>
void copy(ImageView<const T> from, Image<T>& to) {
  for (int v = 0; v < from.height; ++v) std::copy_n(from.row(v), from.width, to.view().row(v));
}

}  // namespace

ResultMessages::ResultMessages(const Camera& camera)
    : rays_x_(camera.intrinsics.width(), camera.intrinsics.height(), no_ray),
      rays_y_(rays_x_),
      header_{0, camera.frame_id},
      virtual_depth_(rays_x_.width(), rays_x_.height()),
      labels_(rays_x_.width(), rays_x_.height()),
      mask_(rays_x_.width(), rays_x_.height()),
      millimetres_(rays_x_.width(), rays_x_.height()),
      metres_(rays_x_.width(), rays_x_.height()) {
  for (int v = 0; v < rays_x_.height(); ++v)
    for (int u = 0; u < rays_x_.width(); ++u) {
      const auto ray = camera.distortion.undistort(camera.intrinsics.ray(u, v).head<2>());
      if (!ray) continue;
      rays_x_(u, v) = static_cast<float>(ray->x());
      rays_y_(u, v) = static_cast<float>(ray->y());
    }
}

void ResultMessages::set(const FrameReport& report, const DepthView& depth) {
  header_.stamp = report.stamp.value_or(0);
  has_virtual_depth_ = !report.virtual_depth.depth.empty();
  if (has_virtual_depth_) copy(report.virtual_depth.depth, virtual_depth_);
  copy(report.labels, labels_);
  const bool is_whole = report.missing_links.empty();
  for (std::size_t i = 0; i < labels_.size(); ++i)
    mask_.data()[i] = is_whole && is_trusted(labels_.data()[i]) ? 0 : 255;
  in_metres_ = std::holds_alternative<ImageView<const float>>(depth);
  if (in_metres_)
    filter(std::get<ImageView<const float>>(depth), metres_,
           std::numeric_limits<float>::quiet_NaN());
  else
    filter(std::get<ImageView<const std::uint16_t>>(depth), millimetres_, std::uint16_t{0});
}

template <typename T>
void ResultMessages::filter(ImageView<const T> depth, Image<T>& filtered, T none) {
  for (int v = 0; v < filtered.height(); ++v)
    for (int u = 0; u < filtered.width(); ++u) {
      const bool kept = !depth.empty() && mask_(u, v) == 0;
      filtered(u, v) = kept ? depth(u, v) : none;
    }
}

template <typename T>
void ResultMessages::add_points(const Image<T>& filtered) {
  points_.clear();
  for (int v = 0; v < filtered.height(); ++v)
    for (int u = 0; u < filtered.width(); ++u) add_point(u, v, metres_of(filtered(u, v)));
}

void ResultMessages::add_point(int u, int v, float z) {
  if (z == 0.0F || std::isnan(rays_x_(u, v))) return;
  points_.insert(points_.end(), {rays_x_(u, v) * z, rays_y_(u, v) * z, z});
}

std::optional<ImageMessage> ResultMessages::virtual_depth() const {
  if (!has_virtual_depth_) return std::nullopt;
  return image_message(header_, "32FC1", virtual_depth_.view());
}

ImageMessage ResultMessages::labels() const {
  return image_message(header_, "8UC1", labels_.view());
}

ImageMessage ResultMessages::mask() const { return image_message(header_, "mono8", mask_.view()); }

ImageMessage ResultMessages::filtered_depth() const {
  return in_metres_ ? image_message(header_, "32FC1", metres_.view())
                    : image_message(header_, "16UC1", millimetres_.view());
}

PointCloud2Message ResultMessages::points() {
  if (in_metres_)
    add_points(metres_);
  else
    add_points(millimetres_);
  PointCloud2Message cloud{.header = header_, .height = 1};
  cloud.width = static_cast<std::uint32_t>(points_.size() / 3);
  cloud.fields = {
      {.name = "x", .offset = 0}, {.name = "y", .offset = 4}, {.name = "z", .offset = 8}};
  cloud.is_bigendian = std::endian::native == std::endian::big;
  cloud.point_step = point_bytes;
  cloud.row_step = cloud.width * point_bytes;
  cloud.data = std::as_bytes(std::span(points_));
  cloud.is_dense = true;
  return cloud;
}

}  // namespace penumbra::io
