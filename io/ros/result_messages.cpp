// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include <penumbra/labels/labels.hpp>

#include <io/ros/image_codec.hpp>
#include <io/ros/result_messages.hpp>

namespace penumbra::io {
namespace {

constexpr std::uint32_t point_bytes = 3 * sizeof(float);
template <typename T>
void copy(ImageView<const T> from, Image<T>& to) {
  for (int v = 0; v < from.height; ++v) std::copy_n(from.row(v), from.width, to.view().row(v));
}

}  // namespace

ResultMessages::ResultMessages(const Camera& camera, const PointsRule& points)
    : cloud_maker_(camera, points),
      header_{0, camera.frame_id},
      virtual_depth_(camera.intrinsics.width(), camera.intrinsics.height()),
      labels_(virtual_depth_.width(), virtual_depth_.height()),
      mask_(labels_) {}

void ResultMessages::set(const FrameReport& report) {
  header_.stamp = report.stamp.value_or(0);
  has_virtual_depth_ = !report.virtual_depth.depth.empty();
  if (has_virtual_depth_) copy(report.virtual_depth.depth, virtual_depth_);
  copy(report.labels, labels_);
  for (std::size_t i = 0; i < labels_.size(); ++i)
    mask_.data()[i] = is_trusted(static_cast<Label>(labels_.data()[i])) ? 0 : 255;
  without_robot(report, filtered_);
}

std::optional<ImageMessage> ResultMessages::virtual_depth() const {
  if (!has_virtual_depth_) return std::nullopt;
  return image_message(header_, "32FC1", virtual_depth_.view());
}

ImageMessage ResultMessages::labels() const {
  return image_message(header_, "8UC1", labels_.view());
}

ImageMessage ResultMessages::mask() const { return image_message(header_, "mono8", mask_.view()); }

std::optional<ImageMessage> ResultMessages::robot_mask() {
  if (!has_virtual_depth_) return std::nullopt;
  robot_mask_ = penumbra::robot_mask({.depth = virtual_depth_.view(), .links = {}});
  return image_message(header_, "mono8", std::as_const(robot_mask_).view());
}

ImageMessage ResultMessages::filtered_depth() const {
  if (const auto* metres = std::get_if<Image<float>>(&filtered_))
    return image_message(header_, "32FC1", metres->view());
  return image_message(header_, "16UC1", std::get<Image<std::uint16_t>>(filtered_).view());
}

PointCloud2Message ResultMessages::points() {
  cloud_maker_.make(filtered_, points_);
  PointCloud2Message cloud{.header = header_, .height = 1};
  cloud.width = static_cast<std::uint32_t>(points_.points.size());
  cloud.fields = {
      {.name = "x", .offset = 0}, {.name = "y", .offset = 4}, {.name = "z", .offset = 8}};
  cloud.point_step = point_bytes;
  cloud.row_step = cloud.width * point_bytes;
  cloud.data = std::as_bytes(std::span(points_.points));
  cloud.is_dense = true;
  return cloud;
}

}  // namespace penumbra::io
