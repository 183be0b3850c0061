// SPDX-License-Identifier: Apache-2.0
// From clusters to the triangles that may cover a pixel centre.
#if defined(PENUMBRA_RENDER_CPU_SELECT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_RENDER_CPU_SELECT_INL
#undef PENUMBRA_RENDER_CPU_SELECT_INL
#else
#define PENUMBRA_RENDER_CPU_SELECT_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include <penumbra/render/cpu/kernel.hpp>
#include <penumbra/render/cpu/scratch-inl.hpp>
#include <penumbra/render/cpu/simd-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

std::size_t Cull(const FrameContext& frame, std::uint32_t group_index, Sides sides,
                 DrawItem* items) {
  const ClusteredScene& scene = *frame.scene;
  const ClusterGroup& group = scene.groups[group_index];
  const BodyFrame& body = frame.bodies[group.body];
  const View& view = *frame.view;
  const Intrinsics& k = view.intrinsics;
  const auto near = hn::Set(df, static_cast<float>(DepthRenderer::near_plane));
  const auto tan_u = hn::Set(df, static_cast<float>(view.guard_u / k.fx()));
  const auto tan_v = hn::Set(df, static_cast<float>(view.guard_v / k.fy()));
  std::size_t count = 0;
  const std::uint32_t end = group.first_cluster + group.cluster_count;
  for (std::uint32_t i = group.first_cluster; i < end; i += kStep) {
    const auto x0 = hn::LoadU(df, &scene.sphere_x[i]);
    const auto y0 = hn::LoadU(df, &scene.sphere_y[i]);
    const auto z0 = hn::LoadU(df, &scene.sphere_z[i]);
    const auto r = hn::LoadU(df, &scene.sphere_radius[i]);
    const auto x = Affine(&body.to_camera[0], x0, y0, z0);
    const auto y = Affine(&body.to_camera[4], x0, y0, z0);
    const auto z = Affine(&body.to_camera[8], x0, y0, z0);
    const auto inside = [&](const ViewSide& side, VF across) HWY_ATTR {
      return hn::MulAdd(hn::Set(df, side.s), across, hn::MulAdd(hn::Set(df, side.t), z, r));
    };
    const auto nearest = hn::Min(hn::Min(inside(view.left, x), inside(view.right, x)),
                                 hn::Min(inside(view.top, y), inside(view.bottom, y)));
    const auto visible = hn::And(hn::Ge(nearest, hn::Zero(df)), hn::Ge(hn::Add(z, r), near));
    const auto z_min = hn::Sub(z, r);
    const auto tame = hn::And(hn::Gt(z_min, near),
                              hn::And(hn::Lt(hn::Add(hn::Abs(x), r), hn::Mul(tan_u, z_min)),
                                      hn::Lt(hn::Add(hn::Abs(y), r), hn::Mul(tan_v, z_min))));
    std::uint32_t visible_bits = Bits(visible);
    const std::uint32_t tame_bits = Bits(tame);
    if (end - i < kStep) visible_bits &= (1U << (end - i)) - 1;
    for (; visible_bits != 0; visible_bits &= visible_bits - 1) {
      const int lane = std::countr_zero(visible_bits);
      items[count++] = {i + static_cast<std::uint32_t>(lane), group_index, group.body, sides,
                        ((tame_bits >> lane) & 1) == 0};
    }
  }
  return count;
}

/// Lists the cluster's triangles whose front (or, where both sides are drawn, back: high bit set)
/// faces the camera.
template <bool kBothSides>
std::size_t FrontFaces(const ClusteredScene& scene, const Cluster& cluster, const BodyFrame& body,
                       std::uint32_t* front) {
  std::size_t count = 0;
  auto index = hn::Iota(du32, 0);
  const auto cx = hn::Set(df, body.centre[0]);
  const auto cy = hn::Set(df, body.centre[1]);
  const auto cz = hn::Set(df, body.centre[2]);
  for (std::uint32_t i = 0; i < cluster.triangle_count; i += kStep) {
    const std::size_t t = cluster.first_triangle + i;
    const auto height = hn::MulAdd(hn::LoadU(df, &scene.plane_x[t]), cx,
                                   hn::MulAdd(hn::LoadU(df, &scene.plane_y[t]), cy,
                                              hn::MulSub(hn::LoadU(df, &scene.plane_z[t]), cz,
                                                         hn::LoadU(df, &scene.plane_d[t]))));
    if constexpr (kBothSides) {
      const auto turned = hn::ShiftLeft<31>(hn::ShiftRight<31>(hn::BitCast(du32, height)));
      const Packer seen(hn::Ne(height, hn::Zero(df)));
      hn::StoreU(seen(hn::Or(index, turned)), du32, front + count);
      count += seen.count();
    } else {
      const Packer seen(hn::Gt(height, hn::Zero(df)));
      hn::StoreU(seen(index), du32, front + count);
      count += seen.count();
    }
    index = hn::Add(index, hn::Set(du32, static_cast<std::uint32_t>(kStep)));
  }
  return count;
}

/// Image points of the cluster's vertices, as pairs, and their bounding box.
Bounds Project(const ClusteredScene& scene, const Cluster& cluster, const BodyFrame& body,
               float* pixels) {
  auto u_min = hn::Set(df, 1e30F);
  auto v_min = u_min;
  auto u_max = hn::Set(df, -1e30F);
  auto v_max = u_max;
  for (std::uint32_t i = 0; i < cluster.vertex_count; i += kStep) {
    const std::size_t p = cluster.first_vertex + i;
    const auto x = hn::LoadU(df, &scene.x[p]);
    const auto y = hn::LoadU(df, &scene.y[p]);
    const auto z = hn::LoadU(df, &scene.z[p]);
    const auto inverse = hn::Div(hn::Set(df, 1.0F), Affine(&body.to_image[8], x, y, z));
    const auto u = hn::Mul(Affine(&body.to_image[0], x, y, z), inverse);
    const auto v = hn::Mul(Affine(&body.to_image[4], x, y, z), inverse);
    hn::StoreInterleaved2(u, v, df, pixels + 2 * i);
    u_min = hn::Min(u_min, u);
    u_max = hn::Max(u_max, u);
    v_min = hn::Min(v_min, v);
    v_max = hn::Max(v_max, v);
  }
  return {hn::GetLane(hn::MinOfLanes(df, u_min)), hn::GetLane(hn::MinOfLanes(df, v_min)),
          hn::GetLane(hn::MaxOfLanes(df, u_max)), hn::GetLane(hn::MaxOfLanes(df, v_max))};
}

/// Where the backs of a group's triangles may be seen, if only somewhere: around its holes.
std::span<const Bounds> Holes(const FrameContext& frame, const DrawItem& item) {
  if (item.sides != Sides::front_and_through_holes) return {};
  const ClusterGroup& group = frame.scene->groups[item.group];
  return {frame.holes + group.first_hole, group.hole_count};
}

bool MeetsAny(std::span<const Bounds> holes, const Bounds& bounds) {
  return std::any_of(holes.begin(), holes.end(),
                     [&](const Bounds& hole) { return hole.meets(bounds); });
}

/// Marks the tiles of the pixel centres inside the bounds; false if there are none in the image.
bool MarkTouched(const Bounds& b, const Intrinsics& k, TileMask& touched) {
  const float u0 = std::max(std::ceil(b.u0), 0.0F);
  const float v0 = std::max(std::ceil(b.v0), 0.0F);
  const float u1 = std::min(std::floor(b.u1), static_cast<float>(k.width() - 1));
  const float v1 = std::min(std::floor(b.v1), static_cast<float>(k.height() - 1));
  if (!(u0 <= u1 && v0 <= v1)) return false;
  touched.mark(static_cast<int>(u0), static_cast<int>(v0), static_cast<int>(u1),
               static_cast<int>(v1));
  return true;
}

/// Copies the image points of the listed triangles' corners side by side.
template <bool kBothSides>
void GatherCorners(const std::uint32_t* corners, std::size_t count, Scratch& s) {
  const auto copy = [&s](std::array<float, 2>& to, std::uint32_t vertex) HWY_ATTR {
    std::memcpy(to.data(), &s.pixels[std::size_t{2} * vertex], sizeof(to));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t triangle = s.front[i] & 0x7fffffffU;
    const std::uint32_t packed = corners[triangle];
    const bool turned = kBothSides && (s.front[i] >> 31) != 0;
    copy(s.corner0[i], packed & 255U);
    copy(turned ? s.corner2[i] : s.corner1[i], (packed >> 8) & 255U);
    copy(turned ? s.corner1[i] : s.corner2[i], packed >> 16);
    s.corner_triangle[i] = triangle;
  }
}

/// Does the same for a cluster that may reach past the near plane or the guard band, clipped and
/// cut into triangles; returns their number.
std::size_t ClipCorners(const FrameContext& frame, const DrawItem& item, std::size_t count,
                        Scratch& s, Canvas& canvas) {
  const ClusteredScene& scene = *frame.scene;
  const Cluster& cluster = scene.clusters[item.cluster];
  const Eigen::Isometry3d& T = frame.bodies[item.body].T_camera_body;
  std::size_t out = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t triangle = s.front[i] & 0x7fffffffU;
    const std::uint32_t packed = scene.corners[cluster.first_triangle + triangle];
    std::array<std::uint32_t, 3> local{packed & 255U, (packed >> 8) & 255U, packed >> 16};
    if ((s.front[i] >> 31) != 0) std::swap(local[1], local[2]);
    std::array<Eigen::Vector3d, 3> points;
    std::array<std::array<float, 2>, 3> pixels;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t p = cluster.first_vertex + local[j];
      points[j] = T * Eigen::Vector3d(scene.x[p], scene.y[p], scene.z[p]);
      pixels[j] = {s.pixels[2 * local[j]], s.pixels[2 * local[j] + 1]};
    }
    const ClippedPolygon polygon = clip(points, pixels, *frame.view);
    for (std::size_t j = 2; j < static_cast<std::size_t>(polygon.count); ++j) {
      s.corner0[out] = polygon.corners[0];
      s.corner1[out] = polygon.corners[j - 1];
      s.corner2[out] = polygon.corners[j];
      s.corner_triangle[out] = triangle;
      const auto [u0, u1] = std::minmax({s.corner0[out][0], s.corner1[out][0], s.corner2[out][0]});
      const auto [v0, v1] = std::minmax({s.corner0[out][1], s.corner1[out][1], s.corner2[out][1]});
      if (MarkTouched({u0, v0, u1, v1}, frame.view->intrinsics, canvas.touched)) ++out;
    }
  }
  return out;
}

/// Keeps the triangles whose bounding box holds a pixel centre of the image.
void Select(const FrameContext& frame, const DrawItem& item, std::size_t count, Scratch& s) {
  const Cluster& cluster = frame.scene->clusters[item.cluster];
  const auto width = hn::Set(df, static_cast<float>(frame.view->intrinsics.width() - 1));
  const auto height = hn::Set(df, static_cast<float>(frame.view->intrinsics.height() - 1));
  std::size_t end = s.survivors;
  for (std::size_t i = 0; i < count; i += kStep) {
    VF u0, v0, u1, v1, u2, v2;
    hn::LoadInterleaved2(df, s.corner0[i].data(), u0, v0);
    hn::LoadInterleaved2(df, s.corner1[i].data(), u1, v1);
    hn::LoadInterleaved2(df, s.corner2[i].data(), u2, v2);
    const auto first_u = hn::Max(hn::Ceil(hn::Min(hn::Min(u0, u1), u2)), hn::Zero(df));
    const auto first_v = hn::Max(hn::Ceil(hn::Min(hn::Min(v0, v1), v2)), hn::Zero(df));
    const auto last_u = hn::Min(hn::Floor(hn::Max(hn::Max(u0, u1), u2)), width);
    const auto last_v = hn::Min(hn::Floor(hn::Max(hn::Max(v0, v1), v2)), height);
    auto covers = hn::And(hn::Le(first_u, last_u), hn::Le(first_v, last_v));
    if (count - i < kStep) covers = hn::And(covers, hn::FirstN(df, count - i));
    const auto triangle = hn::LoadU(du32, &s.corner_triangle[i]);
    const auto absolute = hn::Add(triangle, hn::Set(du32, cluster.first_triangle));
    const std::array<VF, 6> values{u0, v0, u1, v1, u2, v2};
    const Packer keep(covers);
    for (std::size_t j = 0; j < values.size(); ++j) {
      hn::StoreU(keep(values[j]), df, &s.survivor_pixels[j][end]);
    }
    hn::StoreU(hn::Set(du32, item.cluster), du32, &s.survivor_cluster[end]);
    hn::StoreU(keep(absolute), du32, &s.survivor_triangle[end]);
    end += keep.count();
  }
  s.survivors = end;
}

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#endif  // PENUMBRA_RENDER_CPU_SELECT_INL
