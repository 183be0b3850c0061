// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/cloud/cube_face-inl.hpp>

namespace penumbra::cloud {

Eigen::Matrix3d CubeFace::frame(std::size_t face) {
  const auto axis = static_cast<Eigen::Index>(face % 3);
  const double sign = face < 3 ? 1.0 : -1.0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  R(0, (axis + 1) % 3) = 1.0;
  R(1, (axis + 2) % 3) = sign;
  R(2, axis) = sign;
  return R;
}

std::size_t CubeFace::of(const Eigen::Vector3f& ray) {
  Eigen::Index axis = 0;
  ray.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::size_t>(axis) + (ray[axis] > 0.0F ? 0 : 3);
}

/// A radian takes the most pixels at the corner of a face: focal / cos^2.
CubeFace::CubeFace(double beam)
    : beam_(static_cast<float>(beam)),
      reach_(static_cast<int>(std::ceil(3.0 * focal * beam)) + 1),
      nearest_(size / cell, size / cell, nothing),
      around_(nearest_) {}

void CubeFace::show(const VirtualDepthView& seen) {
  seen_ = seen;
  std::fill_n(nearest_.data(), nearest_.size(), nothing);
  std::fill_n(around_.data(), around_.size(), nothing);
  seen.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) {
      const float* const depth = seen.depth.row(v);
      float* const cells = &nearest_(0, v / cell);
      for (int u = u0; u < u1; ++u) {
        const float z = depth[u] > 0.0F ? depth[u] : nothing;
        cells[u / cell] = std::min(cells[u / cell], z);
      }
    }
  });
  const int cells = (reach_ + cell - 1) / cell, last = nearest_.width() - 1;
  seen.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int j = v0 / cell; j < v1 / cell; ++j)
      for (int i = u0 / cell; i < u1 / cell; ++i) {
        const float z = nearest_(i, j);
        if (z == nothing) continue;
        for (int y = std::max(0, j - cells); y <= std::min(last, j + cells); ++y)
          for (int x = std::max(0, i - cells); x <= std::min(last, i + cells); ++x)
            around_(x, y) = std::min(around_(x, y), z);
      }
  });
}

std::optional<PointLabel> CubeFace::label(const FacePoint& point, const RangeRule& rule) const {
  const int u = static_cast<int>(point.u) - 1, v = static_cast<int>(point.v) - 1;
  const std::uint16_t link = seen_.links(u, v);
  float low = nothing, high = 0.0F;
  bool is_one_body = true;
  for (int j = v; j < v + 4; ++j) {
    const std::uint16_t* const links = seen_.links.row(j) + u;
    const float* const depth = seen_.depth.row(j) + u;
    for (int i = 0; i < 4; ++i) {
      is_one_body &= links[i] == link;
      low = std::min(low, depth[i]);
      high = std::max(high, depth[i]);
    }
  }
  if (!is_one_body) return std::nullopt;
  if (link == 0) return PointLabel{};
  const float range_of_depth = point.range / point.ray.z();
  const Label label = rule.on_robot(point.range, low * range_of_depth);
  if (label != rule.on_robot(point.range, high * range_of_depth)) return std::nullopt;
  return PointLabel{label, link};
}

std::uint16_t CubeFace::mixed_link(const FacePoint& point, const RangeRule& rule) const {
  const auto middle_u = static_cast<int>(std::lround(point.u)),
             middle_v = static_cast<int>(std::lround(point.v));
  const Eigen::Vector3f ray = point.ray / point.range;
  float nearest = beam_ * beam_;  // squared angle
  std::uint16_t link = 0;
  for (int v = std::max(0, middle_v - reach_); v <= std::min(size - 1, middle_v + reach_); ++v)
    for (int u = std::max(0, middle_u - reach_); u <= std::min(size - 1, middle_u + reach_); ++u) {
      const float z = seen_.depth(u, v);
      if (!(z > 0.0F)) continue;
      const Eigen::Vector3f beside((static_cast<float>(u) - centre) / focal,
                                   (static_cast<float>(v) - centre) / focal, 1.0F);
      const float length = beside.norm();
      const float angle = (beside / length - ray).squaredNorm();  // of small ones
      if (angle > nearest || !rule.is_mixed(point.range, z * length)) continue;
      nearest = angle;
      link = seen_.links(u, v);
    }
  return link;
}

}  // namespace penumbra::cloud
