// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <variant>

#include <penumbra/targets/target_views.hpp>

#include <io/files/target_overlay.hpp>

namespace penumbra::io {
namespace {

constexpr int ellipse_corners = 48;
constexpr int edge_steps = 8;  // lenses bend edges

PixelPath closed(PixelPath path) {
  if (!path.empty()) path.push_back(path.front());
  return path;
}

PixelPath path_of(const PixelEllipse& ellipse) {
  PixelPath path;
  const Eigen::Vector2d a(std::cos(ellipse.angle), std::sin(ellipse.angle)), b(-a.y(), a.x());
  for (int i = 0; i < ellipse_corners; ++i) {
    const double t = 2.0 * std::numbers::pi * i / ellipse_corners;
    path.emplace_back(ellipse.centre + ellipse.semi_axes.x() * std::cos(t) * a +
                      ellipse.semi_axes.y() * std::sin(t) * b);
  }
  return closed(std::move(path));
}

/// Pixels of a mask that have a neighbour outside, each as a path of its own.
template <typename Inside>
std::vector<PixelPath> borders(int width, int height, const Inside& inside) {
  std::vector<PixelPath> paths;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      if (!inside(u, v)) continue;
      const bool within = u > 0 && v > 0 && u + 1 < width && v + 1 < height && inside(u - 1, v) &&
                          inside(u + 1, v) && inside(u, v - 1) && inside(u, v + 1);
      if (!within) paths.push_back({Eigen::Vector2d(u, v)});
    }
  return paths;
}

std::vector<PixelPath> borders_of(const RunLengthMask& mask) {
  std::vector<std::uint8_t> columns;  // column after column
  columns.reserve(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height));
  std::uint8_t value = 0;
  for (const std::uint32_t count : mask.counts) {
    const std::size_t room = columns.capacity() - columns.size();
    columns.insert(columns.end(), std::min<std::size_t>(count, room), value);
    value = static_cast<std::uint8_t>(1 - value);
  }
  columns.resize(columns.capacity());
  return borders(mask.width, mask.height, [&](int u, int v) {
    return columns[static_cast<std::size_t>(u) * static_cast<std::size_t>(mask.height) +
                   static_cast<std::size_t>(v)] != 0;
  });
}

/// The convex outline of points.
PixelPath hull_of(std::vector<Eigen::Vector2d> points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), before);
  PixelPath hull;
  const auto add_side = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= start + 2) {
        const Eigen::Vector2d a = hull.back() - hull[hull.size() - 2], b = *first - hull.back();
        if (a.x() * b.y() - a.y() * b.x() > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(*first);
    }
    if (!hull.empty()) hull.pop_back();
  };
  add_side(points.begin(), points.end());
  add_side(points.rbegin(), points.rend());
  return closed(std::move(hull));
}

/// Outlines of each kind of shape.
struct Outliner {
  const TargetPoses& poses;
  const Robot& robot;
  const Camera& camera;

  std::vector<PixelPath> operator()(const std::monostate&) const { return {}; }
  std::vector<PixelPath> operator()(const RegionTarget& target) const {
    return std::visit(*this, target.region);
  }
  std::vector<PixelPath> operator()(const PixelBox& box) const {
    const Eigen::Vector2d corner(box.u, box.v), across(box.width - 1, 0), down(0, box.height - 1);
    return {closed({corner, corner + across, corner + across + down, corner + down})};
  }
  std::vector<PixelPath> operator()(const PixelPolygon& polygon) const {
    return {closed({polygon.corners.begin(), polygon.corners.end()})};
  }
  std::vector<PixelPath> operator()(const PixelMask& mask) const {
    return borders(mask.mask.view.width, mask.mask.view.height,
                   [&](int u, int v) { return mask.mask.view(u, v) != 0; });
  }
  std::vector<PixelPath> operator()(const RunLengthMask& mask) const { return borders_of(mask); }
  std::vector<PixelPath> operator()(const PixelEllipse& ellipse) const {
    return {path_of(ellipse)};
  }
  std::vector<PixelPath> operator()(const RenderedRegion& region) const {
    return borders(region.depth.view.width, region.depth.view.height,
                   [&](int u, int v) { return region.depth.view(u, v) > 0.0F; });
  }

  std::vector<PixelPath> operator()(const KeypointTarget& target) const {
    PixelEllipse ellipse{target.pixel, target.semi_axes, target.angle};
    if (target.in_metres && !target.expected_depth) return {{target.pixel}};
    if (target.in_metres) ellipse.semi_axes *= camera.intrinsics.fx() / *target.expected_depth;
    return {path_of(ellipse)};
  }
  std::vector<PixelPath> operator()(const PointTarget& target) const {
    const auto T = T_camera(target.frame);
    if (!T) return {};
    const Eigen::Vector3d p = *T * target.position;
    const auto pixel = pixel_of(camera, p);
    if (!pixel) return {};
    const double radius = camera.intrinsics.fx() * target.radius / p.z();
    return {path_of({*pixel, {radius, radius}, 0.0})};
  }
  std::vector<PixelPath> operator()(const BoxTarget& target) const;
  std::vector<PixelPath> operator()(const MeshTarget& target) const;

  [[nodiscard]] std::optional<Eigen::Isometry3d> T_camera(const ReferenceFrame& frame) const {
    const bool is_camera = frame.kind == ReferenceFrame::Kind::camera;
    if (is_camera && !poses.is_late) return Eigen::Isometry3d::Identity();
    if (!poses.T_root_camera || !poses.T_root_camera_then) return std::nullopt;
    const Eigen::Isometry3d T_camera_root = poses.T_root_camera->inverse();
    if (is_camera) return T_camera_root * *poses.T_root_camera_then;
    if (frame.kind == ReferenceFrame::Kind::root) return T_camera_root;
    const auto link = robot.find_link(frame.link);
    if (!link) return std::nullopt;
    return T_camera_root * poses.T_root_link_then[*link];
  }
};

std::vector<PixelPath> Outliner::operator()(const BoxTarget& target) const {
  const auto T = T_camera(target.frame);
  if (!T) return {};
  const Eigen::Isometry3d T_camera_box = *T * target.pose;
  std::vector<PixelPath> paths;
  for (int axis = 0; axis < 3; ++axis)
    for (const double a : {-0.5, 0.5})
      for (const double b : {-0.5, 0.5}) {
        PixelPath& edge = paths.emplace_back();
        for (int i = 0; i <= edge_steps; ++i) {
          Eigen::Vector3d p;
          p[axis] = static_cast<double>(i) / edge_steps - 0.5;
          p[(axis + 1) % 3] = a;
          p[(axis + 2) % 3] = b;
          if (const auto pixel = pixel_of(camera, T_camera_box * p.cwiseProduct(target.size)))
            edge.push_back(*pixel);
        }
      }
  return paths;
}

std::vector<PixelPath> Outliner::operator()(const MeshTarget& target) const {
  const auto T = T_camera(target.frame);
  if (!T || !target.mesh) return {};
  const Eigen::Isometry3d T_camera_mesh = *T * target.pose;
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3f& vertex : target.mesh->vertices)
    if (const auto pixel = pixel_of(camera, T_camera_mesh * vertex.cast<double>()))
      points.push_back(*pixel);
  return {hull_of(std::move(points))};
}

}  // namespace

std::vector<PixelPath> outline_of(const TargetShape& shape, const TargetPoses& poses,
                                  const Robot& robot, const Camera& camera) {
  return std::visit(Outliner{poses, robot, camera}, shape);
}

}  // namespace penumbra::io
