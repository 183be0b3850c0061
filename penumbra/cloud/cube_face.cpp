// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

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

/// A radian takes the most pixels at the corner of a face: focal / cos^2. A half disc of 1.12
/// pixels holds a pixel's centre.
CubeFace::CubeFace(double beam)
    : beam_(beam > 0.0 ? static_cast<float>(beam) + 1.2F / focal : 0.0F),
      reach_(static_cast<int>(std::ceil(3.0F * focal * static_cast<float>(beam) + 1.2F)) + 1),
      cells_(size / cell, size / cell),
      around_(size / cell, size / cell) {}

PixelRectangle CubeFace::window(const Eigen::AlignedBox2f& points) const {
  const int more = reach_ + 2 * cell;  // whole cells
  const Eigen::Array2i least = points.min().array().cast<int>() - more,
                       most = points.max().array().cast<int>() + more + 1;
  return {std::max(0, least.x()), std::max(0, least.y()), std::min(size, most.x()),
          std::min(size, most.y())};
}

void CubeFace::show(const VirtualDepthView& seen) {
  seen_ = seen;
  std::fill_n(cells_.data(), cells_.size(), std::uint8_t{0});
  std::fill_n(around_.data(), around_.size(), std::uint8_t{0});
  seen.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) {
      const std::uint16_t* const links = seen.links.row(v);
      std::uint8_t* const cells = &cells_(0, v / cell);
      for (int u = u0; u < u1; u += cell) {
        std::uint64_t four = 0;
        static_assert(sizeof four == cell * sizeof(std::uint16_t));  // tiles are wider
        std::memcpy(&four, links + u, sizeof four);
        cells[u / cell] |= four != 0 ? 1 : 0;
      }
    }
  });
  const int reach = (reach_ + cell - 1) / cell, last = cells_.width() - 1;
  const auto is_inner = [&](int i, int j) {
    if (i == 0 || j == 0 || i == last || j == last) return false;
    int robot = 0;
    for (int y = j - 1; y <= j + 1; ++y)
      for (int x = i - 1; x <= i + 1; ++x) robot += cells_(x, y);
    return robot == 9;
  };
  seen.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int j = v0 / cell; j < v1 / cell; ++j)
      for (int i = u0 / cell; i < u1 / cell; ++i) {
        if (cells_(i, j) == 0) continue;
        if (is_inner(i, j)) {  // its reach is within that of cells at the edge, and the cells
          around_(i, j) = 1;
          continue;
        }
        const int first = std::max(0, i - reach), wide = std::min(last, i + reach) + 1 - first;
        for (int y = std::max(0, j - reach); y <= std::min(last, j + reach); ++y)
          std::fill_n(&around_(first, y), wide, std::uint8_t{1});
      }
  });
}

std::optional<PointLabel> CubeFace::label(const FacePoint& point, const RangeRule& rule) const {
  const int u = static_cast<int>(point.u) - 1, v = static_cast<int>(point.v) - 1;
  const std::uint16_t link = seen_.links(u, v);
  float low = seen_.depth(u, v), high = low;
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
  const float range_of_depth = point.range / point.ray.z();
  constexpr float apart = 0.03F;  // share by which ranges of rays in reach differ at most
  float nearest = beam_ * beam_;  // squared angle
  std::uint16_t link = 0;
  for (int v = std::max(0, middle_v - reach_); v <= std::min(size - 1, middle_v + reach_); ++v)
    for (int u = std::max(0, middle_u - reach_); u <= std::min(size - 1, middle_u + reach_); ++u) {
      const float z = seen_.depth(u, v);
      const float near = z * range_of_depth;
      if (!(z > 0.0F) || !rule.is_mixed(point.range, near, apart * near)) continue;
      const Eigen::Vector3f nearby((static_cast<float>(u) - centre) / focal,
                                   (static_cast<float>(v) - centre) / focal, 1.0F);
      const float length = nearby.norm();
      const float angle = (nearby / length - ray).squaredNorm();  // of small ones
      if (angle > nearest || !rule.is_mixed(point.range, z * length)) continue;
      nearest = angle;
      link = seen_.links(u, v);
    }
  return link;
}

}  // namespace penumbra::cloud
