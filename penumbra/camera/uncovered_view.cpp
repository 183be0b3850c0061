// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <penumbra/camera/uncovered_view.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;

/// Of the cone's reach: the outermost rays of pixels that it does cover.
constexpr double outermost_rays = 1e-3;

/// Whether the box holds any of the optical axis from the camera backwards.
bool is_behind(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& T_camera_box) {
  const Eigen::Isometry3d T_box_camera = T_camera_box.inverse();
  const Vector3d eye = T_box_camera.translation(), back = -T_box_camera.linear().col(2);
  double from = 0.0, to = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (back[i] == 0.0) {
      if (eye[i] < box.min()[i] || eye[i] > box.max()[i]) return false;
      continue;
    }
    const auto [enter, leave] =
        std::minmax({(box.min()[i] - eye[i]) / back[i], (box.max()[i] - eye[i]) / back[i]});
    from = std::max(from, enter);
    to = std::min(to, leave);
  }
  return from <= to;
}

}  // namespace

UncoveredView::UncoveredView(const Camera& raw, const Rectification& rectification)
    : reach_(std::min(std::tan(rectification.half_angle()), raw.distortion.max_radius()) *
             (1.0 - outermost_rays)) {
  const auto covered = rectification.raw_to_pinhole();
  for (int v = 0; v < covered.height; ++v) {
    for (int u = 0; u < covered.width; ++u) {
      if (covered(u, v) != Rectification::no_pixel) continue;
      // Lenses turn rays about the axis by less than a sector.
      const int sector = sector_of(raw.intrinsics.ray(u, v));
      for (const int beside : {sectors - 1, 0, 1})
        sectors_.set(static_cast<std::size_t>((sector + beside) % sectors));
    }
  }
}

bool UncoveredView::is_covered(const Vector3d& point) const {
  return point.z() > 0.0 && point.head<2>().norm() <= reach_ * point.z();
}

int UncoveredView::sector_of(const Vector3d& point) {
  const double turns = std::atan2(point.y(), point.x()) / (2.0 * std::numbers::pi) + 0.5;
  return std::min(static_cast<int>(turns * sectors), sectors - 1);
}

bool UncoveredView::holds(const Vector3d& point) const {
  return sectors_.any() && point.allFinite() && !is_covered(point) &&
         sectors_.test(static_cast<std::size_t>(sector_of(point)));
}

/// Along the line between two points.
bool UncoveredView::holds_part_of(const Vector3d& a, const Vector3d& b) const {
  // Where the line passes the cone, and its other half behind the camera.
  const Vector3d step = b - a;
  const Vector3d form(1.0, 1.0, -reach_ * reach_);
  const double square = form.dot(step.cwiseAbs2());
  const double linear = form.dot(a.cwiseProduct(step));
  const double constant = form.dot(a.cwiseAbs2());
  const double root = std::sqrt(std::max(linear * linear - square * constant, 0.0));
  const double outer = -linear - std::copysign(root, linear);  // of both signs without cancellation
  std::array<double, 4> at{0.0, 1.0, outer / square, constant / outer};
  for (double& t : at) t = std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.0;
  std::sort(at.begin(), at.end());
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (is_covered(a + 0.5 * (at[i] + at[i + 1]) * step)) continue;
    const Vector3d from = a + at[i] * step, to = a + at[i + 1] * step;
    const int first = sector_of(from);
    // A line is seen within half a turn about the axis, the way that its ends say.
    const int way = from.x() * to.y() >= from.y() * to.x() ? 1 : sectors - 1;
    for (int sector = first;; sector = (sector + way) % sectors) {
      if (sectors_.test(static_cast<std::size_t>(sector))) return true;
      if (sector == sector_of(to)) break;
    }
  }
  return false;
}

/// In each half plane from the optical axis, what of the box lies furthest beyond the cone is on
/// one of its edges, or on the axis behind the camera, which is on all sides.
bool UncoveredView::holds_part_of(const Eigen::AlignedBox3d& box,
                                  const Eigen::Isometry3d& T_camera_box) const {
  if (sectors_.none()) return false;
  if (is_behind(box, T_camera_box)) return true;
  std::array<Vector3d, 8> corners;
  for (unsigned i = 0; i < corners.size(); ++i)
    corners[i] = T_camera_box * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  if (std::all_of(corners.begin(), corners.end(),
                  [this](const Vector3d& corner) { return is_covered(corner); }))
    return false;  // and so is what is between them, as the cone is convex
  for (unsigned i = 0; i < corners.size(); ++i)
    for (const unsigned axis : {1U, 2U, 4U})  // a corner's bits: its side of each axis
      if ((i & axis) == 0 && holds_part_of(corners[i], corners[i | axis])) return true;
  return false;
}

}  // namespace penumbra
