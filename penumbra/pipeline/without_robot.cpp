// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
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
        const bool has_depth = depth != nullptr && !depth->empty();
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

void PointsRule::check() const {
  check_settings(*this);
  constexpr double least_voxel = 0.001;  // metres: the cubes of an axis are numbered by 21 bits
  if (voxel > 0 && voxel < least_voxel)
    throw InputError("points_voxel: expected 0, or 0.001 m or more");
}

CloudMaker::CloudMaker(const Camera& camera, const PointsRule& rule)
    : rule_(rule),
      rays_x_(camera.intrinsics.width(), camera.intrinsics.height(),
              std::numeric_limits<float>::quiet_NaN()),
      rays_y_(rays_x_) {
  rule.check();
  if (rule.voxel > 0) cubes_.resize(std::bit_ceil(2 * rays_x_.size()));
  for (int v = 0; v < rays_x_.height(); ++v)
    for (int u = 0; u < rays_x_.width(); ++u) {
      const auto ray = camera.distortion.undistort(camera.intrinsics.ray(u, v).head<2>());
      if (!ray) continue;
      rays_x_(u, v) = static_cast<float>(ray->x());
      rays_y_(u, v) = static_cast<float>(ray->y());
    }
}

bool CloudMaker::is_first_in_cube(const Eigen::Vector3f& point) {
  constexpr std::uint64_t mask = (1ULL << 21U) - 1;  // cubes per axis
  const Eigen::Array3d at = point.cast<double>().array() / rule_.voxel;
  std::uint64_t cube = 1ULL << 63U;
  for (int axis = 0; axis < 3; ++axis) {
    const auto towards_zero = static_cast<std::int64_t>(at[axis]);
    const std::int64_t floor =
        towards_zero - (static_cast<double>(towards_zero) > at[axis] ? 1 : 0);
    cube |= (static_cast<std::uint64_t>(floor) & mask) << 21 * axis;
  }
  if (cube == std::exchange(last_cube_, cube)) return false;  // mostly that of the next pixel, too
  // Multiplicative hashing of y and z, whose highest bits depend on all. Neighbours in x are
  // neighbours in memory, as pixels are.
  const auto unused_bits = static_cast<unsigned>(std::countl_zero(cubes_.size() - 1));
  std::uint64_t place = ((cube >> 21U) * 0x9E3779B97F4A7C15ULL >> unused_bits) + (cube & mask);
  for (;; ++place) {
    std::uint64_t& entry = cubes_[place & (cubes_.size() - 1)];
    if (entry == cube) return false;
    if (entry != 0) continue;
    entry = cube;
    return true;
  }
}

void CloudMaker::make(const DepthImage& depth, PointCloud& cloud,
                      const Eigen::Isometry3d& T_frame_camera) {
  cloud.points.clear();
  cloud.pixels.clear();
  std::fill(cubes_.begin(), cubes_.end(), 0);
  last_cube_ = 0;
  const auto farthest =
      static_cast<float>(rule_.range > 0 ? rule_.range : std::numeric_limits<double>::infinity());
  const bool is_moved = !T_frame_camera.matrix().isIdentity(0.0);
  const Eigen::Isometry3f T = T_frame_camera.cast<float>();
  std::visit(
      [&](const auto& image) {
        assert(image.width() == rays_x_.width() && image.height() == rays_x_.height());
        for (int v = 0; v < image.height(); v += rule_.stride)
          for (int u = 0; u < image.width(); u += rule_.stride) {
            const float z = metres_of(image(u, v));
            if (z == 0.0F || std::isnan(rays_x_(u, v))) continue;
            Eigen::Vector3f point(rays_x_(u, v) * z, rays_y_(u, v) * z, z);
            if (point.norm() > farthest) continue;
            if (is_moved) point = T * point;
            if (!cubes_.empty() && !is_first_in_cube(point)) continue;
            cloud.points.push_back(point);
            cloud.pixels.push_back(static_cast<std::uint32_t>(v * image.width() + u));
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

Image<std::uint8_t> robot_mask(const Robot& robot, const Camera& camera, const RobotPose& pose) {
  PipelineConfig config;
  config.has_depth = false;
  Pipeline pipeline(robot, camera, config);
  const FrameReport& report = pipeline.process({.pose = pose});
  if (report.status != FrameStatus::ok) throw InputError("robot_mask: " + report.message);
  for (const Joint& joint : robot.joints()) {
    if (!joint.variable || !joint.lower || !joint.upper || pose.positions.empty()) continue;
    const double at = joint.multiplier * pose.positions[*joint.variable] + joint.offset;
    const double range = *joint.upper - *joint.lower;
    if (range > 0.0 && std::max(*joint.lower - at, at - *joint.upper) > range)
      throw InputError("robot_mask: joint '" + joint.name + "' is at " + std::to_string(at) +
                       ", far beyond its limits: expected radians or metres");
  }
  if (!report.near_links.empty())
    throw InputError("robot_mask: part of link '" + robot.links()[report.near_links.front()] +
                     "' lies within 1 cm of the camera and cannot be drawn: correct the camera's "
                     "pose, or name the link in ignore_links");
  return robot_mask(report.virtual_depth);
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
