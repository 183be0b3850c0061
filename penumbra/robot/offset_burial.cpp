// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <penumbra/robot/offset_burial-inl.hpp>
#include <penumbra/robot/offset_directions-inl.hpp>
#include <penumbra/robot/surface_offset.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;

constexpr double spacing = 0.12;  // of tested points, in margins: of one another's neighbours

int steps_for(double length) { return std::max(1, static_cast<int>(std::ceil(length / spacing))); }

bool is_clear(const Vector3d& a, const Vector3d& b) {
  return angle_between(a, b) < 0.9 * std::numbers::pi;
}

}  // namespace

/// Whether all points nearer to p than the tested ones lie to each other are inside.
bool Burial::hides(const Vector3d& p) const {
  constexpr double between = spacing * 0.71;  // half of the diagonal of four points
  return tree_.comes_within(p, margin_ * (1.0 - offset_error - between));
}

bool Burial::hides_arc(const Vector3d& p, const Vector3d& from, const Vector3d& to) const {
  const int steps = steps_for(angle_between(from, to));
  for (int i = 0; i <= steps; ++i)
    if (!hides(p + margin_ * along(from, to, static_cast<double>(i) / steps))) return false;
  return true;
}

bool Burial::hides_edge(const Vector3d& a, const Vector3d& b, const Vector3d& from,
                        const Vector3d& to) const {
  if (!is_clear(from, to)) return false;
  const int steps = steps_for((b - a).norm() / margin_);
  for (int i = 0; i <= steps; ++i)
    if (!hides_arc(a + (b - a) * (static_cast<double>(i) / steps), from, to)) return false;
  return true;
}

bool Burial::hides_corner(const Vector3d& p, const Vector3d& centre,
                          std::span<const Vector3d> normals) const {
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vector3d& from = normals[i];
    const Vector3d& to = normals[(i + 1) % normals.size()];
    if (!is_clear(from, to) || !is_clear(centre, from) || !is_clear(centre, to)) return false;
    const int steps = steps_for(angle_between(from, to));
    for (int k = 0; k < steps; ++k)
      if (!hides_arc(p, centre, along(from, to, static_cast<double>(k) / steps))) return false;
  }
  return true;
}

}  // namespace penumbra::offset
