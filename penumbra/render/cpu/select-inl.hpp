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
#include <limits>
#include <span>
#include <utility>

#include <penumbra/render/cpu/kernel.hpp>
#include <penumbra/render/cpu/scratch-inl.hpp>
#include <penumbra/render/cpu/simd-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

std::size_t Cull(const FrameContext& frame, std::uint32_t group_index, Sides sides, bool second,
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
    // The margin of IsHidden holds only for clusters whose depth varies little.
    const auto flat = hn::Lt(hn::Mul(r, hn::Set(df, 8.0F)), z_min);
    const auto toward = hn::MulAdd(
        hn::LoadU(df, &scene.normal_x[i]), hn::Sub(hn::Set(df, body.centre[0]), x0),
        hn::MulAdd(
            hn::LoadU(df, &scene.normal_y[i]), hn::Sub(hn::Set(df, body.centre[1]), y0),
            hn::Mul(hn::LoadU(df, &scene.normal_z[i]), hn::Sub(hn::Set(df, body.centre[2]), z0))));
    const auto away = hn::Lt(toward, hn::Zero(df));
    HWY_ALIGN std::array<float, kStep> nearest_of;
    hn::Store(hn::IfThenElse(hn::And(tame, flat), hn::Div(hn::Set(df, 1.0F), z_min),
                             hn::Set(df, std::numeric_limits<float>::infinity())),
              df, nearest_of.data());
    std::uint32_t visible_bits = Bits(visible);
    const std::uint32_t tame_bits = Bits(tame);
    if (sides == Sides::both) visible_bits &= second ? Bits(away) : ~Bits(away);
    if (end - i < kStep) visible_bits &= (1U << (end - i)) - 1;
    for (; visible_bits != 0; visible_bits &= visible_bits - 1) {
      const int lane = std::countr_zero(visible_bits);
      items[count++] = {i + static_cast<std::uint32_t>(lane),
                        group_index,
                        group.body,
                        sides,
                        ((tame_bits >> lane) & 1) == 0,
                        second,
                        nearest_of[static_cast<std::size_t>(lane)]};
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

/// Whether all pixels inside the bounds hold something nearer than 1/z = `nearest`.
bool IsHidden(const Bounds& b, float nearest, const Intrinsics& k, const Canvas& canvas) {
  // Pixels of triangles seen edge-on exceed their depth (sliver_excess), and words lose low bits.
  constexpr float margin = 1.004F;
  constexpr float around = 1.0F;  // pixels: more than sliver_reach
  constexpr float most = 512.0F;  // pixels
  if (!(b.u1 - b.u0 < most && b.v1 - b.v0 < most)) return false;
  const auto clamp = [](float at, int size) {
    return static_cast<std::size_t>(std::clamp(at, 0.0F, static_cast<float>(size - 1)));
  };
  const std::size_t first = clamp(b.u0 - around, k.width()) / block_width;
  const std::size_t last = clamp(b.u1 + around, k.width()) / block_width;
  const std::size_t begin = clamp(b.v0 - around, k.height()) / kBlockHeight;
  const std::size_t end = clamp(b.v1 + around, k.height()) / kBlockHeight;
  const auto at = [&](std::size_t column, std::size_t row) HWY_ATTR {
    return hn::Load(di, canvas.packed.data() + row * canvas.lanes_per_row + column * kStep);
  };
  const auto bound = hn::Set(di, std::bit_cast<std::int32_t>(margin * nearest));
  // The middle block usually decides.
  if (!hn::AllTrue(di, hn::Gt(at((first + last) / 2, (begin + end) / 2), bound))) return false;
  for (std::size_t row = begin; row <= end; ++row) {
    auto farthest = at(first, row);
    for (std::size_t i = first + 1; i <= last; ++i) farthest = hn::Min(farthest, at(i, row));
    if (!hn::AllTrue(di, hn::Gt(farthest, bound))) return false;
  }
  return true;
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
void GatherCorners(const std::uint32_t* corners, std::size_t count, Scratch& s) {
  const auto copy = [&s](std::array<float, 2>& to, std::uint32_t vertex) HWY_ATTR {
    std::memcpy(to.data(), &s.pixels[std::size_t{2} * vertex], sizeof(to));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t triangle = s.front[i] & 0x7fffffffU;
    const std::uint32_t packed = corners[triangle];
    // Where it is turned, the second and the third change places: without a branch, since half of
    // them are.
    const std::uint32_t turn = (packed >> 8 ^ packed >> 16) & (0U - (s.front[i] >> 31));
    copy(s.corner0[i], packed & 255U);
    copy(s.corner1[i], (packed >> 8 ^ turn) & 255U);
    copy(s.corner2[i], (packed >> 16 ^ turn) & 255U);
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

/// Where the edge from p to q has the pixel centres (u, v) to (u + 1, v + 1) on its outer side: the
/// signs of its function there.
HWY_INLINE std::array<VF, 4> AtCentres(VF pu, VF pv, VF qu, VF qv, VF u, VF v, VF bias) {
  const auto du = hn::Sub(qv, pv);
  const auto dv = hn::Sub(pu, qu);
  const auto first = hn::MulAdd(du, hn::Sub(u, pu), hn::MulAdd(dv, hn::Sub(v, pv), bias));
  const auto below = hn::Add(first, dv);
  return {first, hn::Add(first, du), below, hn::Add(below, du)};
}

/// Which triangles may cover one of the pixel centres (u, v) to (u + 1, v + 1). The bias is three
/// times as large as that of the edge functions that decide (MakeEdge), which covers the roundings
/// here and there: none that covers one is missed. A pixel outside the bounding box, which only
/// that bias would reach, may be.
HWY_INLINE hn::Mask<DF> MayCover(const std::array<VF, 6>& p, VF u, VF v, VF width, VF height) {
  const auto margin = hn::Set(df, edge_margin);
  const auto terms =
      hn::MulAdd(width, hn::Add(height, margin), hn::Mul(height, hn::Add(width, margin)));
  const auto bias = hn::Mul(terms, hn::Set(df, 3.0F * edge_rounding));
  const auto e0 = AtCentres(p[0], p[1], p[2], p[3], u, v, bias);
  const auto e1 = AtCentres(p[2], p[3], p[4], p[5], u, v, bias);
  const auto e2 = AtCentres(p[4], p[5], p[0], p[1], u, v, bias);
  auto missed = hn::Or(hn::Or(e0[0], e1[0]), e2[0]);
  for (std::size_t i = 1; i < e0.size(); ++i)
    missed = hn::And(missed, hn::Or(hn::Or(e0[i], e1[i]), e2[i]));
  return hn::RebindMask(df, hn::Gt(hn::BitCast(di, missed), hn::Set(di, -1)));
}

/// Keeps the triangles that may cover a pixel centre of the image: their bounding box holds one
/// and, if it holds at most 2 x 2, one of these is inside.
void Select(const FrameContext& frame, const DrawItem& item, std::size_t count, Scratch& s) {
  const Cluster& cluster = frame.scene->clusters[item.cluster];
  const auto last_column = hn::Set(df, static_cast<float>(frame.view->intrinsics.width() - 1));
  const auto last_row = hn::Set(df, static_cast<float>(frame.view->intrinsics.height() - 1));
  std::size_t end = s.survivors;
  for (std::size_t i = 0; i < count; i += kStep) {
    std::array<VF, 6> p;
    hn::LoadInterleaved2(df, s.corner0[i].data(), p[0], p[1]);
    hn::LoadInterleaved2(df, s.corner1[i].data(), p[2], p[3]);
    hn::LoadInterleaved2(df, s.corner2[i].data(), p[4], p[5]);
    const auto u_min = hn::Min(hn::Min(p[0], p[2]), p[4]);
    const auto v_min = hn::Min(hn::Min(p[1], p[3]), p[5]);
    const auto u_max = hn::Max(hn::Max(p[0], p[2]), p[4]);
    const auto v_max = hn::Max(hn::Max(p[1], p[3]), p[5]);
    const auto first_u = hn::Max(hn::Ceil(u_min), hn::Zero(df));
    const auto first_v = hn::Max(hn::Ceil(v_min), hn::Zero(df));
    const auto columns = hn::Sub(hn::Min(hn::Floor(u_max), last_column), first_u);
    const auto rows = hn::Sub(hn::Min(hn::Floor(v_max), last_row), first_v);
    auto covers = hn::Ge(hn::Min(columns, rows), hn::Zero(df));
    if (count - i < kStep) covers = hn::And(covers, hn::FirstN(df, count - i));
    if (hn::AllFalse(df, covers)) continue;
    const auto size = hn::Max(columns, rows);
    const auto width = hn::Sub(u_max, u_min), height = hn::Sub(v_max, v_min);
    const auto tiny = hn::Lt(size, hn::Set(df, 2.0F));
    covers = hn::And(covers, hn::Or(hn::Not(tiny), MayCover(p, first_u, first_v, width, height)));
    const auto triangle = hn::LoadU(du32, &s.corner_triangle[i]);
    const auto absolute = hn::Add(triangle, hn::Set(du32, cluster.first_triangle));
    const Packer keep(covers);
    for (std::size_t j = 0; j < p.size(); ++j) {
      hn::StoreU(keep(p[j]), df, &s.survivor_pixels[j][end]);
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
