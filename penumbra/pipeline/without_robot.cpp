// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/without_robot.hpp>

namespace penumbra {
namespace {

template <typename T>
constexpr T no_depth = std::numeric_limits<T>::has_quiet_NaN ? std::numeric_limits<T>::quiet_NaN()
                                                             : T{0};

}  // namespace

void without_robot(const FrameReport& report, DepthImage& out) {
  const ImageView<const std::uint8_t>& labels = report.labels;
  std::visit(
      [&](const auto& depth) {
        using T = std::remove_const_t<std::remove_reference_t<decltype(*depth.data)>>;
        if (!depth.empty() && !std::holds_alternative<Image<T>>(out)) out = Image<T>();
      },
      report.depth);
  std::visit(
      [&]<typename T>(Image<T>& image) {
        image.fit(labels.width, labels.height);
        const auto* const depth = std::get_if<ImageView<const T>>(&report.depth);
        const bool has_depth = depth != nullptr && !depth->empty() && report.missing_links.empty();
        for (int v = 0; v < labels.height; ++v) {
          const std::uint8_t* const label = labels.row(v);
          T* const to = &image(0, v);
          if (!has_depth) {
            std::fill_n(to, labels.width, no_depth<T>);
            continue;
          }
          const T* const from = depth->row(v);
          for (int u = 0; u < labels.width; ++u)
            to[u] = is_trusted(static_cast<Label>(label[u])) ? from[u] : no_depth<T>;
        }
      },
      out);
}

CloudMaker::CloudMaker(const Camera& camera)
    : rays_x_(camera.intrinsics.width(), camera.intrinsics.height(),
              std::numeric_limits<float>::quiet_NaN()),
      rays_y_(rays_x_) {
  for (int v = 0; v < rays_x_.height(); ++v)
    for (int u = 0; u < rays_x_.width(); ++u) {
      const auto ray = camera.distortion.undistort(camera.intrinsics.ray(u, v).head<2>());
      if (!ray) continue;
      rays_x_(u, v) = static_cast<float>(ray->x());
      rays_y_(u, v) = static_cast<float>(ray->y());
    }
}

void CloudMaker::make(const DepthImage& depth, PointCloud& cloud,
                      const Eigen::Isometry3d& T_frame_camera) const {
  cloud.points.clear();
  cloud.pixels.clear();
  const bool is_moved = !T_frame_camera.matrix().isIdentity(0.0);
  const Eigen::Isometry3f T = T_frame_camera.cast<float>();
  std::visit(
      [&](const auto& image) {
        assert(image.width() == rays_x_.width() && image.height() == rays_x_.height());
        for (std::size_t i = 0; i < image.size(); ++i) {
          const float z = metres_of(image.data()[i]);
          if (z == 0.0F || std::isnan(rays_x_.data()[i])) continue;
          const Eigen::Vector3f point(rays_x_.data()[i] * z, rays_y_.data()[i] * z, z);
          cloud.points.push_back(is_moved ? T * point : point);
          cloud.pixels.push_back(static_cast<std::uint32_t>(i));
        }
      },
      depth);
}

std::optional<Eigen::Isometry3d> camera_in_link(const FrameReport& report, std::string_view link) {
  const auto found = std::find(report.links.begin(), report.links.end(), link);
  const auto index = static_cast<std::size_t>(found - report.links.begin());
  if (found == report.links.end() || (report.T_root_camera && index >= report.T_root_link.size()))
    throw InputError("no link '" + std::string(link) + "': the robot's root is '" +
                     report.links.front() + "'; `penumbra inspect URDF` lists its links");
  if (!report.T_root_camera) return std::nullopt;
  return report.T_root_link[index].inverse() * *report.T_root_camera;
}

Image<std::uint8_t> robot_mask(const VirtualDepthView& virtual_depth) {
  const auto& depth = virtual_depth.depth;
  Image<std::uint8_t> mask(depth.width, depth.height);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u) mask(u, v) = depth(u, v) > 0.0F ? 255 : 0;
  return mask;
}

Image<std::uint8_t> front_of(const ImageView<const float>& virtual_depth, const DepthView& measured,
                             const Tolerance& tolerance) {
  return std::visit(
      [&](const auto& seen) {
        if (seen.width != virtual_depth.width || seen.height != virtual_depth.height)
          throw InputError("the depth image is " + std::to_string(seen.width) + "x" +
                           std::to_string(seen.height) + ", the virtual one " +
                           std::to_string(virtual_depth.width) + "x" +
                           std::to_string(virtual_depth.height));
        Image<std::uint8_t> front(seen.width, seen.height);
        for (int v = 0; v < seen.height; ++v)
          for (int u = 0; u < seen.width; ++u) {
            const float z = virtual_depth(u, v);
            if (!(z > 0.0F)) continue;
            const float d = metres_of(seen(u, v));
            const bool is_before = d > 0.0F && d < z - static_cast<float>(tolerance.at(z));
            front(u, v) = is_before ? 0 : 255;
          }
        return front;
      },
      measured);
}

}  // namespace penumbra
