// SPDX-License-Identifier: Apache-2.0
// The renderer's kernel, compiled once per SIMD target.
//
// A frame's clusters go through: cull (bounding spheres against the view), front faces (planes
// against the camera's centre), project (vertices), select (bounding boxes that hold a pixel
// centre), set up (edge functions and depth planes, sorted by size into bins), fill (one unrolled
// routine per size), resolve (packed 1/z to depth and link images).
//
// Edge functions are those of Pineda 1988, "A parallel algorithm for polygon rasterization". They
// get a bias above their rounding error, some 1e-6 of the triangle's size, so that a pixel on a
// shared edge belongs to one of its triangles at least. The depth buffer takes the maximum of 1/z:
// covering a pixel twice is harmless.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <penumbra/render/cpu/kernel.hpp>
#include <penumbra/render/cpu/scratch-inl.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "penumbra/render/cpu/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DF = HWY_CAPPED(float, 16);
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
constexpr DF df;
constexpr DI di;
constexpr DU du32;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(df));
constexpr std::size_t kStep = static_cast<std::size_t>(kLanes);
constexpr int kBlockHeight = kLanes / block_width;
static_assert(kLanes >= 4 && kLanes <= 16);

HWY_INLINE VF Dot3(const float* row, VF x, VF y, VF z) {
  return hn::MulAdd(hn::Set(df, row[0]), x,
                    hn::MulAdd(hn::Set(df, row[1]), y, hn::Mul(hn::Set(df, row[2]), z)));
}

HWY_INLINE VF Affine(const float* row, VF x, VF y, VF z) {
  return hn::MulAdd(
      hn::Set(df, row[0]), x,
      hn::MulAdd(hn::Set(df, row[1]), y, hn::MulAdd(hn::Set(df, row[2]), z, hn::Set(df, row[3]))));
}

/// One bit for each lane. (Reading more bytes than were written would wait for the store.)
HWY_INLINE std::uint32_t Bits(hn::Mask<DF> mask) {
  std::array<std::uint8_t, 8> bytes;  // Highway asks for eight
  hn::StoreMaskBits(df, mask, bytes.data());
  return kLanes > 8 ? bytes[0] | std::uint32_t{bytes[1]} << 8U : bytes[0];
}

// ------------------------------------------------------------------------------------- cull

/// A side of the view as a plane through the camera's centre: inside, s x + t z >= 0.
struct Side {
  float s, t;
  Side(double sign, double tangent)
      : s(static_cast<float>(sign / std::hypot(1.0, tangent))),
        t(static_cast<float>(tangent / std::hypot(1.0, tangent))) {}
};

std::size_t Cull(const FrameContext& frame, const Shell& shell, bool both_sides, DrawItem* items) {
  const ClusteredScene& scene = *frame.scene;
  const BodyFrame& body = frame.bodies[shell.body];
  const Intrinsics& k = frame.view->intrinsics;
  // One pixel of margin on each side.
  const Side left(1.0, (k.cx() + 1.0) / k.fx());
  const Side right(-1.0, (k.width() - k.cx()) / k.fx());
  const Side top(1.0, (k.cy() + 1.0) / k.fy());
  const Side bottom(-1.0, (k.height() - k.cy()) / k.fy());
  const auto near = hn::Set(df, static_cast<float>(DepthRenderer::near_plane));
  const auto tan_u = hn::Set(df, static_cast<float>(frame.view->guard_u / k.fx()));
  const auto tan_v = hn::Set(df, static_cast<float>(frame.view->guard_v / k.fy()));
  std::size_t count = 0;
  const std::uint32_t end = shell.first_cluster + shell.cluster_count;
  for (std::uint32_t i = shell.first_cluster; i < end; i += kStep) {
    const auto x0 = hn::LoadU(df, &scene.sphere_x[i]);
    const auto y0 = hn::LoadU(df, &scene.sphere_y[i]);
    const auto z0 = hn::LoadU(df, &scene.sphere_z[i]);
    const auto r = hn::LoadU(df, &scene.sphere_radius[i]);
    const auto x = Affine(&body.to_camera[0], x0, y0, z0);
    const auto y = Affine(&body.to_camera[4], x0, y0, z0);
    const auto z = Affine(&body.to_camera[8], x0, y0, z0);
    const auto inside = [&](const Side& side, VF across) HWY_ATTR {
      return hn::MulAdd(hn::Set(df, side.s), across, hn::MulAdd(hn::Set(df, side.t), z, r));
    };
    const auto nearest = hn::Min(hn::Min(inside(left, x), inside(right, x)),
                                 hn::Min(inside(top, y), inside(bottom, y)));
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
      items[count++] = {i + static_cast<std::uint32_t>(lane), shell.body, both_sides,
                        ((tame_bits >> lane) & 1) == 0};
    }
  }
  return count;
}

// ------------------------------------------------------------------------------------- front faces

/// Moves a vector's marked lanes to its front.
class Packer {
 public:
  explicit Packer(hn::Mask<DF> mask) : bits_(Bits(mask)) {
#if HWY_TARGET == HWY_AVX3
    mask_ = mask;
#else
    const hn::Rebind<std::uint8_t, DI> bytes;
    order_ = hn::IndicesFromVec(df, hn::PromoteTo(di, hn::LoadU(bytes, kOrders[bits_].data())));
#endif
  }
  [[nodiscard]] std::size_t count() const { return hwy::PopCount(bits_); }
  [[nodiscard]] HWY_INLINE VF operator()(VF v) const {
#if HWY_TARGET == HWY_AVX3
    return hn::Compress(v, mask_);
#else
    return hn::TableLookupLanes(v, order_);
#endif
  }
  template <typename V>
  [[nodiscard]] HWY_INLINE V operator()(V v) const {
    return hn::BitCast(hn::DFromV<V>(), (*this)(hn::BitCast(df, v)));
  }

 private:
  std::uint32_t bits_;
#if HWY_TARGET == HWY_AVX3
  hn::Mask<DF> mask_;
#else
  // Highway 1.0 copies its own table to the stack at every use.
  using Order = std::array<std::uint8_t, kStep>;
  static constexpr std::array<Order, 1 << kLanes> kOrders = [] {
    std::array<Order, 1 << kLanes> orders{};
    for (std::size_t bits = 0; bits < orders.size(); ++bits) {
      std::size_t end = 0;
      for (std::uint8_t lane = 0; lane < kStep; ++lane) {
        if ((bits >> lane & 1) != 0) orders[bits][end++] = lane;
      }
    }
    return orders;
  }();
  decltype(hn::IndicesFromVec(df, hn::Zero(di))) order_;
#endif
};

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

// ------------------------------------------------------------------------------------- project

struct Bounds {
  float u0, v0, u1, v1;
};

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

// ------------------------------------------------------------------------------------- corners

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

// ------------------------------------------------------------------------------------- select

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

// ------------------------------------------------------------------------------------- fill

/// Constants of the fill routines.
struct Target {
  std::int32_t* packed;
  std::size_t lanes_per_row;
  VI keep;  // mask of the bits that stay depth
};

/// A vector of values at one block's pixels.
struct Values {
  VF edge0, edge1, edge2, inverse_depth;
};

HWY_INLINE Values Slope(const Record::Quartet& q, float factor) {
  const auto f = hn::Set(df, factor);
  return {hn::Mul(hn::Set(df, q.edge0), f), hn::Mul(hn::Set(df, q.edge1), f),
          hn::Mul(hn::Set(df, q.edge2), f), hn::Mul(hn::Set(df, q.inverse_depth), f)};
}

HWY_INLINE void Advance(Values& values, const Values& slope) {
  values.edge0 = hn::Add(values.edge0, slope.edge0);
  values.edge1 = hn::Add(values.edge1, slope.edge1);
  values.edge2 = hn::Add(values.edge2, slope.edge2);
  values.inverse_depth = hn::Add(values.inverse_depth, slope.inverse_depth);
}

HWY_INLINE Values Start(const Record& r, VF du, VF dv) {
  const auto at = [&](float base, float slope_u, float slope_v) HWY_ATTR {
    return hn::MulAdd(hn::Set(df, slope_u), du,
                      hn::MulAdd(hn::Set(df, slope_v), dv, hn::Set(df, base)));
  };
  return {at(r.base.edge0, r.du.edge0, r.dv.edge0), at(r.base.edge1, r.du.edge1, r.dv.edge1),
          at(r.base.edge2, r.du.edge2, r.dv.edge2),
          at(r.base.inverse_depth, r.du.inverse_depth, r.dv.inverse_depth)};
}

/// The depth test: the maximum of what is there and, in lanes where no edge function is negative,
/// of 1/z with the id in its low bits.
HWY_INLINE void Update(std::int32_t* block, const Values& v, VI keep, VI id) {
  const auto outside = hn::Or(hn::Or(v.edge0, v.edge1), v.edge2);
  const auto word = hn::Or(hn::And(hn::BitCast(di, v.inverse_depth), keep), id);
  const auto inside =
      hn::BitCast(di, hn::IfNegativeThenElse(outside, hn::Zero(df), hn::BitCast(df, word)));
  hn::Store(hn::Max(hn::Load(di, block), inside), di, block);
}

/// u and v of each lane's pixel from the block's first.
HWY_INLINE VF LaneU() {
  return hn::ConvertTo(df, hn::And(hn::Iota(di, 0), hn::Set(di, block_width - 1)));
}
HWY_INLINE VF LaneV() { return hn::ConvertTo(df, hn::ShiftRight<2>(hn::Iota(di, 0))); }

template <int kWidth, int kHeight>
void FillBlocks(std::span<const Record> records, const Target& target) {
  const auto lane_u = LaneU();
  const auto lane_v = LaneV();
  for (const Record& r : records) {
    const auto id = hn::Set(di, r.id);
    Values row = Start(r, lane_u, lane_v);
    [[maybe_unused]] const Values right = Slope(r.du, block_width);
    [[maybe_unused]] const Values down = Slope(r.dv, kBlockHeight);
    std::int32_t* block = target.packed + r.offset;
    HWY_UNROLL(8) for (int y = 0; y < kHeight; ++y) {
      Values values = row;
      HWY_UNROLL(4) for (int x = 0; x < kWidth; ++x) {
        Update(block + x * kLanes, values, target.keep, id);
        if (x + 1 < kWidth) Advance(values, right);
      }
      if (y + 1 < kHeight) {
        Advance(row, down);
        block += target.lanes_per_row;
      }
    }
  }
}

template <int kWidth>
void FillPieces(const PieceBin& bin, const Record* records, const Target& target) {
  const auto lane_u = LaneU();
  const auto lane_v = LaneV();
  for (std::size_t i = 0; i < bin.count; ++i) {
    const Record& r = records[bin.record[i]];
    const auto id = hn::Set(di, r.id);
    Values values =
        Start(r, hn::Add(lane_u, hn::Set(df, bin.du[i])), hn::Add(lane_v, hn::Set(df, bin.dv[i])));
    [[maybe_unused]] const Values right = Slope(r.du, block_width);
    std::int32_t* block = target.packed + bin.offset[i];
    HWY_UNROLL(8) for (int x = 0; x < kWidth; ++x) {
      Update(block + x * kLanes, values, target.keep, id);
      if (x + 1 < kWidth) Advance(values, right);
    }
  }
}

template <std::size_t... kLengths>
void FlushPieces(Scratch& s, const Target& target, std::index_sequence<kLengths...> /*lengths*/) {
  const Record* records = s.records.data();
  (FillPieces<static_cast<int>(kLengths + 1)>(s.pieces[kLengths], records, target), ...);
  for (PieceBin& bin : s.pieces) bin.count = 0;
  s.piece_count = 0;
}

void FlushPieces(Scratch& s, const Target& target) {
  FlushPieces(s, target, std::make_index_sequence<Scratch::longest_piece>());
}

// ------------------------------------------------------------------------------------- pieces

/// An edge function solved for u along block rows: columns u >= low(e) and u <= high(e) are inside,
/// one of which does not bound.
struct EdgeLine {
  VF base, slope_v;
  VF low_scale, low_offset, high_scale, high_offset;

  EdgeLine(float value, float slope_u, float slope_v_) {
    // A block row is entered where any of its pixel rows is.
    const float reach = std::max(slope_v_, 0.0F) * static_cast<float>(kBlockHeight - 1);
    constexpr float flat = 1e-30F;  // an edge along the row: all of it, or none
    const float divisor = std::abs(slope_u) < flat ? flat : slope_u;
    constexpr float far = 1e9F;
    const float scale = -1.0F / divisor;
    base = hn::Set(df, value + reach);
    slope_v = hn::Set(df, slope_v_);
    low_scale = hn::Set(df, divisor > 0 ? scale : 0.0F);
    low_offset = hn::Set(df, divisor > 0 ? 0.0F : -far);
    high_scale = hn::Set(df, divisor > 0 ? 0.0F : scale);
    high_offset = hn::Set(df, divisor > 0 ? far : 0.0F);
  }
  [[nodiscard]] HWY_INLINE VF at(VF v) const { return hn::MulAdd(slope_v, v, base); }
  [[nodiscard]] HWY_INLINE VF low(VF e) const { return hn::MulAdd(e, low_scale, low_offset); }
  [[nodiscard]] HWY_INLINE VF high(VF e) const { return hn::MulAdd(e, high_scale, high_offset); }
};

/// What is constant while a large triangle is cut into runs.
struct LargeTriangle {
  EdgeLine a, b, c;
  VF end;  // pixels from its first
  VI offset, height;

  explicit LargeTriangle(const Record& r)
      : a(r.base.edge0, r.du.edge0, r.dv.edge0),
        b(r.base.edge1, r.du.edge1, r.dv.edge1),
        c(r.base.edge2, r.du.edge2, r.dv.edge2),
        end(hn::Set(df, static_cast<float>(r.width * block_width))),
        offset(hn::Set(di, static_cast<std::int32_t>(r.offset))),
        height(hn::Set(di, r.height)) {}
};

/// Adds a run of blocks of any length.
void AddPiece(Scratch& s, Piece piece, std::int32_t blocks) {
  while (blocks > 0) {
    const std::int32_t length = std::min(blocks, static_cast<std::int32_t>(Scratch::longest_piece));
    s.pieces[static_cast<std::size_t>(length) - 1].push(piece);
    piece.offset += length * kLanes;
    piece.du += static_cast<float>(length * block_width);
    blocks -= length;
  }
}

/// Up to kLanes block rows of a large triangle: where its run of blocks begins in each, and how
/// many blocks it has.
struct Runs {
  VI offset, blocks;
  VF du, dv;
};

HWY_INLINE Runs FindRuns(const LargeTriangle& t, int y, VI row_offsets) {
  const auto rows = hn::Add(hn::Iota(di, 0), hn::Set(di, y));
  const auto v = hn::Mul(hn::ConvertTo(df, rows), hn::Set(df, static_cast<float>(kBlockHeight)));
  const auto a = t.a.at(v);
  const auto b = t.b.at(v);
  const auto c = t.c.at(v);
  const auto rounding = hn::Set(df, 0.01F);  // pixels; more only costs blocks
  const auto low = hn::Sub(hn::Max(hn::Max(t.a.low(a), t.b.low(b)), t.c.low(c)), rounding);
  const auto high = hn::Add(hn::Min(hn::Min(t.a.high(a), t.b.high(b)), t.c.high(c)), rounding);
  const auto low_pixel = hn::Min(hn::Max(hn::Ceil(low), hn::Zero(df)), t.end);
  const auto high_pixel =
      hn::Min(hn::Max(hn::Floor(high), hn::Set(df, -1.0F)), hn::Sub(t.end, hn::Set(df, 1.0F)));
  const auto first = hn::ShiftRight<2>(hn::ConvertTo(di, low_pixel));
  const auto last = hn::ShiftRight<2>(hn::ConvertTo(di, high_pixel));
  Runs runs;
  runs.blocks =
      hn::IfThenElseZero(hn::Gt(t.height, rows), hn::Sub(hn::Add(last, hn::Set(di, 1)), first));
  runs.offset = hn::Add(hn::Add(row_offsets, hn::Mul(first, hn::Set(di, kLanes))), t.offset);
  runs.du = hn::ConvertTo(df, hn::ShiftLeft<2>(first));
  runs.dv = v;
  return runs;
}

/// Adds the runs in the marked lanes as pieces of one length.
HWY_INLINE void AddRuns(PieceBin& bin, const Runs& runs, std::int32_t record, hn::Mask<DI> mask) {
  const Packer keep(hn::RebindMask(df, mask));
  hn::StoreU(hn::Set(di, record), di, &bin.record[bin.count]);
  hn::StoreU(keep(runs.offset), di, &bin.offset[bin.count]);
  hn::StoreU(keep(runs.du), df, &bin.du[bin.count]);
  hn::StoreU(keep(runs.dv), df, &bin.dv[bin.count]);
  bin.count += keep.count();
}

/// Adds the runs of more than two blocks, which are few.
void AddLongRuns(Scratch& s, const Runs& runs, std::int32_t record, std::uint32_t lanes) {
  HWY_ALIGN std::array<std::int32_t, kStep> offset, blocks;
  HWY_ALIGN std::array<float, kStep> du, dv;
  hn::Store(runs.offset, di, offset.data());
  hn::Store(runs.blocks, di, blocks.data());
  hn::Store(runs.du, df, du.data());
  hn::Store(runs.dv, df, dv.data());
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
    AddPiece(s, {record, offset[i], du[i], dv[i]}, blocks[i]);
  }
}

/// Cuts a large triangle into runs of blocks along its block rows.
HWY_INLINE void CutIntoPieces(Scratch& s, const Record& r, int height, const Target& target) {
  const auto index = static_cast<std::int32_t>(&r - s.records.data());
  const LargeTriangle triangle(r);
  const auto row_lanes = static_cast<std::int32_t>(target.lanes_per_row);
  auto row_offsets = hn::Mul(hn::Iota(di, 0), hn::Set(di, row_lanes));
  const std::size_t most = kStep * (static_cast<std::size_t>(r.width) / Scratch::longest_piece + 1);
  for (int y = 0; y < height; y += kLanes) {
    if (HWY_UNLIKELY(s.piece_count > PieceBin::budget)) FlushPieces(s, target);
    s.piece_count += most;
    const Runs runs = FindRuns(triangle, y, row_offsets);
    AddRuns(s.pieces[0], runs, index, hn::Eq(runs.blocks, hn::Set(di, 1)));
    AddRuns(s.pieces[1], runs, index, hn::Eq(runs.blocks, hn::Set(di, 2)));
    row_offsets = hn::Add(row_offsets, hn::Set(di, row_lanes * kLanes));
    const std::uint32_t longer = Bits(hn::RebindMask(df, hn::Gt(runs.blocks, hn::Set(di, 2))));
    if (longer != 0) AddLongRuns(s, runs, index, longer);
  }
}

/// Cuts the triangles of a bin. Those of the last bin have any height, others (kBin + 1) kLanes
/// block rows at the most.
template <std::size_t kBin>
void CutBin(Scratch& s, const Target& target) {
  constexpr bool any = kBin + 1 == Scratch::large_bins;
  for (const Record& r : s.bin(Scratch::small_bins + kBin)) {
    CutIntoPieces(s, r, any ? r.height : static_cast<int>(kBin + 1) * kLanes, target);
  }
}

/// Fills all records of all bins.
template <std::size_t... kSmall, std::size_t... kLarge>
void Flush(Scratch& s, const Target& target, std::index_sequence<kSmall...> /*small*/,
           std::index_sequence<kLarge...> /*large*/) {
  (FillBlocks<static_cast<int>(kSmall % Scratch::small_width + 1),
              static_cast<int>(kSmall / Scratch::small_width + 1)>(s.bin(kSmall), target),
   ...);
  (CutBin<kLarge>(s, target), ...);
  FlushPieces(s, target);
  s.clear_bins();
}

void Flush(Scratch& s, const Target& target) {
  Flush(s, target, std::make_index_sequence<Scratch::small_bins>(),
        std::make_index_sequence<Scratch::large_bins>());
}

// ------------------------------------------------------------------------------------- set up

/// Bounding boxes of up to kStep triangles, and where their first blocks are.
struct Boxes {
  VF first_u, first_v;  // the first block's first pixel
  VI offset, width, height, bin;
  VF extent;  // pixels, unclipped
};

HWY_INLINE Boxes BoundBlocks(const std::array<VF, 6>& p, const Intrinsics& k,
                             std::size_t lanes_per_row) {
  const auto& [u0, v0, u1, v1, u2, v2] = p;
  const auto u_min = hn::Min(hn::Min(u0, u1), u2);
  const auto v_min = hn::Min(hn::Min(v0, v1), v2);
  const auto u_max = hn::Max(hn::Max(u0, u1), u2);
  const auto v_max = hn::Max(hn::Max(v0, v1), v2);
  const auto last_u = hn::Set(df, static_cast<float>(k.width() - 1));
  const auto last_v = hn::Set(df, static_cast<float>(k.height() - 1));
  constexpr int kHeightShift = kBlockHeight == 4 ? 2 : kBlockHeight == 2 ? 1 : 0;
  const auto left = hn::ShiftRight<2>(hn::ConvertTo(di, hn::Max(hn::Ceil(u_min), hn::Zero(df))));
  const auto top =
      hn::ShiftRight<kHeightShift>(hn::ConvertTo(di, hn::Max(hn::Ceil(v_min), hn::Zero(df))));
  const auto right = hn::ShiftRight<2>(hn::ConvertTo(di, hn::Min(hn::Floor(u_max), last_u)));
  const auto bottom =
      hn::ShiftRight<kHeightShift>(hn::ConvertTo(di, hn::Min(hn::Floor(v_max), last_v)));
  Boxes b;
  b.first_u = hn::ConvertTo(df, hn::ShiftLeft<2>(left));
  b.first_v = hn::ConvertTo(df, hn::ShiftLeft<kHeightShift>(top));
  b.offset = hn::Add(hn::Mul(top, hn::Set(di, static_cast<std::int32_t>(lanes_per_row))),
                     hn::Mul(left, hn::Set(di, kLanes)));
  b.width = hn::Add(hn::Sub(right, left), hn::Set(di, 1));
  b.height = hn::Add(hn::Sub(bottom, top), hn::Set(di, 1));
  const auto small = hn::And(hn::Lt(b.width, hn::Set(di, Scratch::small_width + 1)),
                             hn::Lt(b.height, hn::Set(di, Scratch::small_height + 1)));
  const auto row = hn::Mul(hn::Sub(b.height, hn::Set(di, 1)), hn::Set(di, Scratch::small_width));
  constexpr int kLanesShift = kBlockHeight == 4 ? 4 : kBlockHeight == 2 ? 3 : 2;
  const auto batches = hn::ShiftRight<kLanesShift>(hn::Sub(b.height, hn::Set(di, 1)));
  const auto large = hn::Min(batches, hn::Set(di, static_cast<int>(Scratch::large_bins) - 1));
  b.bin = hn::IfThenElse(small, hn::Add(row, hn::Sub(b.width, hn::Set(di, 1))),
                         hn::Add(large, hn::Set(di, static_cast<int>(Scratch::small_bins))));
  b.extent = hn::Add(hn::Sub(u_max, u_min), hn::Sub(v_max, v_min));
  return b;
}

struct EdgeFunction {
  VF base, du, dv;
};

/// The edge from p to q. Its bias exceeds the rounding of all later sums.
HWY_INLINE EdgeFunction MakeEdge(VF pu, VF pv, VF qu, VF qv, const Boxes& b) {
  EdgeFunction e;
  e.du = hn::Sub(qv, pv);
  e.dv = hn::Sub(pu, qu);
  const auto reach = hn::Mul(hn::Add(b.extent, hn::Set(df, 16.0F)), hn::Set(df, 0x1p-20F));
  const auto bias = hn::Mul(hn::Add(hn::Abs(e.du), hn::Abs(e.dv)), reach);
  e.base = hn::MulAdd(e.du, hn::Sub(b.first_u, pu), hn::MulAdd(e.dv, hn::Sub(b.first_v, pv), bias));
  return e;
}

struct DepthPlanes {
  VF base, du, dv;
};

/// Inverse depth of the survivors' planes at their first pixels.
HWY_INLINE DepthPlanes MakeDepthPlanes(const FrameContext& frame, const Scratch& s,
                                       std::size_t start, std::size_t count, const Boxes& b) {
  const ClusteredScene& scene = *frame.scene;
  const BodyFrame& body = frame.bodies[s.survivor_body];
  HWY_ALIGN std::array<std::array<float, kStep>, 4> plane;
  for (std::size_t i = 0; i < kStep; ++i) {
    const std::size_t t = s.survivor_triangle[start + i];
    plane[0][i] = scene.plane_x[t];
    plane[1][i] = scene.plane_y[t];
    plane[2][i] = scene.plane_z[t];
    plane[3][i] = scene.plane_d[t];
  }
  const auto x = hn::Load(df, plane[0].data());
  const auto y = hn::Load(df, plane[1].data());
  const auto z = hn::Load(df, plane[2].data());
  const auto height = hn::MulAdd(
      x, hn::Set(df, body.centre[0]),
      hn::MulAdd(y, hn::Set(df, body.centre[1]),
                 hn::MulSub(z, hn::Set(df, body.centre[2]), hn::Load(df, plane[3].data()))));
  const auto scale = hn::Div(hn::Set(df, -1.0F), height);
  DepthPlanes out;
  out.du = hn::Mul(Dot3(&body.inverse_depth[0], x, y, z), scale);
  out.dv = hn::Mul(Dot3(&body.inverse_depth[3], x, y, z), scale);
  const auto origin = hn::Mul(Dot3(&body.inverse_depth[6], x, y, z), scale);
  out.base = hn::MulAdd(out.du, b.first_u, hn::MulAdd(out.dv, b.first_v, origin));
  const auto grazing = hn::Lt(hn::Abs(height), hn::Set(df, body.grazing));
  if (HWY_LIKELY(hn::AllFalse(df, grazing))) return out;
  HWY_ALIGN std::array<float, kStep> base, du, dv, first_u, first_v, grazes;
  hn::Store(out.base, df, base.data());
  hn::Store(out.du, df, du.data());
  hn::Store(out.dv, df, dv.data());
  hn::Store(b.first_u, df, first_u.data());
  hn::Store(b.first_v, df, first_v.data());
  hn::Store(hn::IfThenElseZero(grazing, hn::Set(df, 1.0F)), df, grazes.data());
  for (std::size_t i = 0; i < count; ++i) {
    if (grazes[i] == 0.0F) continue;
    const InverseDepth exact = grazing_inverse_depth(
        scene, scene.clusters[s.survivor_cluster[start + i]], s.survivor_triangle[start + i], body,
        *frame.view, first_u[i], first_v[i]);
    base[i] = exact.base;
    du[i] = exact.du;
    dv[i] = exact.dv;
  }
  return {hn::Load(df, base.data()), hn::Load(df, du.data()), hn::Load(df, dv.data())};
}

/// Makes records of up to kStep survivors and sorts them into the bins.
void SetUp(const FrameContext& frame, std::size_t start, std::size_t count, Scratch& s,
           const Target& target) {
  std::array<VF, 6> p;
  for (std::size_t j = 0; j < p.size(); ++j) p[j] = hn::LoadU(df, &s.survivor_pixels[j][start]);
  const Boxes b = BoundBlocks(p, frame.view->intrinsics, target.lanes_per_row);
  const EdgeFunction e0 = MakeEdge(p[0], p[1], p[2], p[3], b);
  const EdgeFunction e1 = MakeEdge(p[2], p[3], p[4], p[5], b);
  const EdgeFunction e2 = MakeEdge(p[4], p[5], p[0], p[1], b);
  const DepthPlanes z = MakeDepthPlanes(frame, s, start, count, b);
  const auto as_float = [](VI v) HWY_ATTR { return hn::BitCast(df, v); };
  HWY_ALIGN float base[4 * kStep];
  HWY_ALIGN float du[4 * kStep];
  HWY_ALIGN float dv[4 * kStep];
  HWY_ALIGN float rest[4 * kStep];
  HWY_ALIGN std::int32_t bin[kStep];
  hn::StoreInterleaved4(e0.base, e1.base, e2.base, z.base, df, base);
  hn::StoreInterleaved4(e0.du, e1.du, e2.du, z.du, df, du);
  hn::StoreInterleaved4(e0.dv, e1.dv, e2.dv, z.dv, df, dv);
  hn::StoreInterleaved4(as_float(b.offset), as_float(hn::Set(di, frame.bodies[s.survivor_body].id)),
                        as_float(b.width), as_float(b.height), df, rest);
  hn::Store(b.bin, di, bin);
  const hn::Full128<float> quartet;
  for (std::size_t i = 0; i < count; ++i) {
    const auto which = static_cast<std::size_t>(bin[i]);
    auto* record = reinterpret_cast<float*>(s.bin_ends[which]++);
    hn::Store(hn::Load(quartet, base + 4 * i), quartet, record);
    hn::Store(hn::Load(quartet, du + 4 * i), quartet, record + 4);
    hn::Store(hn::Load(quartet, dv + 4 * i), quartet, record + 8);
    hn::Store(hn::Load(quartet, rest + 4 * i), quartet, record + 12);
  }
  s.record_count += count;
  if (s.record_count > Scratch::budget) Flush(s, target);
}

void SetUpSurvivors(const FrameContext& frame, Scratch& s, const Target& target) {
  // Lanes behind the last survivor are computed too: with some triangle's plane.
  std::fill_n(s.survivor_triangle.begin() + static_cast<std::ptrdiff_t>(s.survivors), kStep, 0U);
  for (std::size_t i = 0; i < s.survivors; i += kStep) {
    SetUp(frame, i, std::min(kStep, s.survivors - i), s, target);
  }
  s.survivors = 0;
}

// ------------------------------------------------------------------------------------- draw

/// Takes one cluster up to the survivors.
void Collect(const FrameContext& frame, const DrawItem& item, Scratch& s, Canvas& canvas) {
  const ClusteredScene& scene = *frame.scene;
  const Cluster& cluster = scene.clusters[item.cluster];
  const BodyFrame& body = frame.bodies[item.body];
  const std::uint32_t* corners = &scene.corners[cluster.first_triangle];
  std::size_t count = item.both_sides ? FrontFaces<true>(scene, cluster, body, s.front.data())
                                      : FrontFaces<false>(scene, cluster, body, s.front.data());
  if (count == 0) return;
  const Bounds bounds = Project(scene, cluster, body, s.pixels.data());
  if (item.clip) {
    count = ClipCorners(frame, item, count, s, canvas);
  } else {
    if (!MarkTouched(bounds, frame.view->intrinsics, canvas.touched)) return;
    if (item.both_sides) {
      GatherCorners<true>(corners, count, s);
    } else {
      GatherCorners<false>(corners, count, s);
    }
  }
  Select(frame, item, count, s);
}

void Draw(const FrameContext& frame, std::span<const DrawItem> items, Scratch& s, Canvas& canvas) {
  const Target target{canvas.packed.data(), canvas.lanes_per_row,
                      hn::Set(di, ~frame.packing.id_mask)};
  for (const DrawItem& item : items) {
    if (item.body != s.survivor_body || s.survivors > Scratch::max_survivors) {
      SetUpSurvivors(frame, s, target);
      s.survivor_body = item.body;
    }
    Collect(frame, item, s, canvas);
  }
  SetUpSurvivors(frame, s, target);
  Flush(s, target);
}

// ------------------------------------------------------------------------------------- resolve

/// Stores two neighbouring blocks' values in their rows of an image.
template <typename T, typename Store>
HWY_INLINE void StoreRows(VF left, VF right, T* image, std::size_t stride, Store store) {
  if constexpr (kBlockHeight == 4) {
    // Pixel rows of both blocks side by side: 0 and 1, 2 and 3.
    const hn::Half<DF> half;
    const auto low = hn::ConcatLowerLower(df, right, left);
    const auto high = hn::ConcatUpperUpper(df, right, left);
    HWY_ALIGN static constexpr std::int32_t kOrder[16] = {0, 1, 2, 3, 8,  9,  10, 11,
                                                          4, 5, 6, 7, 12, 13, 14, 15};
    const auto order = hn::SetTableIndices(df, kOrder);
    const auto rows01 = hn::TableLookupLanes(low, order);
    const auto rows23 = hn::TableLookupLanes(high, order);
    store(half, hn::LowerHalf(half, rows01), image);
    store(half, hn::UpperHalf(half, rows01), image + stride);
    store(half, hn::LowerHalf(half, rows23), image + 2 * stride);
    store(half, hn::UpperHalf(half, rows23), image + 3 * stride);
  } else if constexpr (kBlockHeight == 2) {
    store(df, hn::ConcatLowerLower(df, right, left), image);
    store(df, hn::ConcatUpperUpper(df, right, left), image + stride);
  } else {
    store(df, left, image);
    store(df, right, image + block_width);
  }
}

struct TileSpan {
  std::size_t u, v;    // first pixel
  std::size_t blocks;  // in a row; even
};

/// Takes the nearest of all canvases and empties them.
HWY_INLINE VI TakeBlock(std::int32_t* first, std::span<Canvas> others, std::size_t offset) {
  auto word = hn::Load(di, first + offset);
  hn::Store(hn::Zero(di), di, first + offset);
  for (Canvas& canvas : others) {
    std::int32_t* block = canvas.packed.data() + offset;
    word = hn::Max(word, hn::Load(di, block));
    hn::Store(hn::Zero(di), di, block);
  }
  return word;
}

void ResolveSpan(std::span<Canvas> canvases, const Packing& packing, const TileSpan& span,
                 const Output& output) {
  const auto id_mask = hn::Set(di, packing.id_mask);
  const auto half_step = hn::Set(di, packing.half_step);
  const auto smallest = hn::BitCast(di, hn::Set(df, 1e-30F));  // 1/m
  std::int32_t* const packed = canvases[0].packed.data();
  const std::span<Canvas> others = canvases.subspan(1);
  const std::size_t stride = output.stride;
  const auto depth_of = [&](VI word) HWY_ATTR {
    // An empty lane's half step would be a denormal, which divides slowly: keep it a normal number.
    const auto bits = hn::Max(hn::Or(hn::AndNot(id_mask, word), half_step), smallest);
    return hn::IfThenElseZero(hn::RebindMask(df, hn::Ne(word, hn::Zero(di))),
                              hn::Div(hn::Set(df, 1.0F), hn::BitCast(df, bits)));
  };
  const auto id_of = [&](VI word) HWY_ATTR { return hn::BitCast(df, hn::And(word, id_mask)); };
  const auto store_depth = [](auto d, auto values, float* to)
                               HWY_ATTR { hn::StoreU(values, d, to); };
  const auto store_id = [](auto d, auto values, std::uint16_t* to) HWY_ATTR {
    const hn::Rebind<std::uint16_t, decltype(d)> narrow;
    const hn::RebindToSigned<decltype(d)> wide;
    hn::StoreU(hn::DemoteTo(narrow, hn::BitCast(wide, values)), narrow, to);
  };
  for (std::size_t v = span.v; v < span.v + TileMask::tile_height; v += kBlockHeight) {
    const std::size_t offset =
        v / kBlockHeight * canvases[0].lanes_per_row + span.u / block_width * kStep;
    float* depth = output.depth + v * stride + span.u;
    std::uint16_t* links = output.links + v * stride + span.u;
    for (std::size_t i = 0; i < span.blocks; i += 2) {
      const auto left = TakeBlock(packed, others, offset + i * kStep);
      const auto right = TakeBlock(packed, others, offset + (i + 1) * kStep);
      StoreRows(depth_of(left), depth_of(right), depth + i * block_width, stride, store_depth);
      StoreRows(id_of(left), id_of(right), links + i * block_width, stride, store_id);
    }
  }
}

std::uint64_t Resolve(std::span<Canvas> canvases, const Packing& packing, std::uint64_t previous,
                      std::size_t row, const Output& output) {
  std::uint64_t touched = 0;
  for (Canvas& canvas : canvases) touched |= std::exchange(canvas.touched.rows[row], 0);
  const auto tile_width = static_cast<std::size_t>(canvases[0].touched.tile_width);
  for (std::uint64_t bits = touched | previous; bits != 0;) {
    const int first = std::countr_zero(bits);
    const int count = std::countr_one(bits >> first);
    ResolveSpan(canvases, packing,
                {static_cast<std::size_t>(first) * tile_width, row * TileMask::tile_height,
                 static_cast<std::size_t>(count) * tile_width / block_width},
                output);
    bits = first + count >= 64 ? 0 : bits & (~std::uint64_t{0} << (first + count));
  }
  return touched;
}

Kernel MakeKernel() { return {kLanes, &Cull, &Draw, &Resolve}; }

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <penumbra/base/simd_dispatch-inl.hpp>

namespace penumbra::cpu {

void ScratchDeleter::operator()(Scratch* scratch) const { delete scratch; }

ScratchPtr make_scratch() { return ScratchPtr(new Scratch); }

HWY_EXPORT(MakeKernel);

Kernel kernel_for(std::int64_t target) { return PENUMBRA_SIMD_FUNCTION(MakeKernel, target)(); }

}  // namespace penumbra::cpu

#endif  // HWY_ONCE
