// SPDX-License-Identifier: Apache-2.0
// From image points to records: edge functions, depth planes, bins.
#if defined(PENUMBRA_RENDER_CPU_SETUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_RENDER_CPU_SETUP_INL
#undef PENUMBRA_RENDER_CPU_SETUP_INL
#else
#define PENUMBRA_RENDER_CPU_SETUP_INL
#endif

#include <algorithm>
#include <array>
#include <bit>

#include <penumbra/render/cpu/kernel.hpp>
#include <penumbra/render/cpu/pieces-inl.hpp>
#include <penumbra/render/cpu/sliver-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

/// Bounding boxes of up to kStep triangles, and where their first blocks are.
struct Boxes {
  VF first_u, first_v;  // the first block's first pixel
  VI offset, width, height, bin;
  VF width_px, height_px;  // unclipped
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
  b.width_px = hn::Sub(u_max, u_min);
  b.height_px = hn::Sub(v_max, v_min);
  return b;
}

struct EdgeFunction {
  VF base, du, dv;
};

/// The edge from p to q. Its bias exceeds the rounding of its value at any pixel: some six
/// roundings (2^-24 each) of terms over the whole triangle, unclipped, and a dozen over the last 32
/// pixels.
HWY_INLINE EdgeFunction MakeEdge(VF pu, VF pv, VF qu, VF qv, const Boxes& b) {
  EdgeFunction e;
  e.du = hn::Sub(qv, pv);
  e.dv = hn::Sub(pu, qu);
  const auto margin = hn::Set(df, edge_margin);
  const auto terms = hn::MulAdd(hn::Abs(e.du), hn::Add(b.width_px, margin),
                                hn::Mul(hn::Abs(e.dv), hn::Add(b.height_px, margin)));
  const auto bias = hn::Mul(terms, hn::Set(df, edge_rounding));
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

/// Twice the bound of the edge functions' biases: one that is b lets a corner's weight fall to -b /
/// area, and two may do so.
HWY_INLINE VF TwoBiases(const Boxes& b) {
  const auto margin = hn::Set(df, edge_margin);
  const auto terms = hn::MulAdd(b.width_px, hn::Add(b.height_px, margin),
                                hn::Mul(b.height_px, hn::Add(b.width_px, margin)));
  return hn::Mul(terms, hn::Set(df, 2.0F * edge_rounding));
}

// Triangles are slivers where the biases reach further than this beyond them, or to depths of
// which 1/z exceeds theirs by more than a share. Both at the worst: roundings seldom add up.
constexpr float sliver_reach = 0.5F;  // pixels
constexpr float sliver_excess = 1e-3F;

HWY_INLINE VF TwiceArea(const EdgeFunction& first, const EdgeFunction& last) {
  return hn::MulSub(first.du, last.dv, hn::Mul(first.dv, last.du));
}

/// Which triangles are surely no slivers. None of no area is.
HWY_INLINE hn::Mask<DF> AreTame(const std::array<VF, 6>& p, const Boxes& b, VF area,
                                const DepthPlanes& z) {
  const auto range = hn::MulAdd(hn::Abs(z.du), b.width_px, hn::Mul(hn::Abs(z.dv), b.height_px));
  const auto corner = hn::MulAdd(z.du, hn::Sub(p[0], b.first_u),
                                 hn::MulAdd(z.dv, hn::Sub(p[1], b.first_v), z.base));
  const auto half = hn::Mul(corner, hn::Set(df, 0.5F));  // less than any where the range is less
  const auto length = hn::Max(b.width_px, b.height_px);
  const auto beyond = hn::Max(hn::Mul(range, hn::Set(df, 1.0F / sliver_excess)),
                              hn::Mul(hn::Mul(length, half), hn::Set(df, 1.0F / sliver_reach)));
  return hn::And(hn::Gt(half, range), hn::Gt(hn::Mul(area, half), hn::Mul(TwoBiases(b), beyond)));
}

/// Which triangles are slivers.
HWY_INLINE hn::Mask<DF> AreSlivers(const std::array<VF, 6>& p, const Boxes& b, VF area,
                                   const DepthPlanes& z) {
  constexpr float thin = 4.0F;              // pixels
  constexpr float excess_of_thick = 0.25F;  // to whom a hundredth of a pixel makes more difference
  const auto depth_at = [&](VF u, VF v) HWY_ATTR {
    return hn::MulAdd(z.du, hn::Sub(u, b.first_u), hn::MulAdd(z.dv, hn::Sub(v, b.first_v), z.base));
  };
  const auto d0 = depth_at(p[0], p[1]);
  const auto d1 = depth_at(p[2], p[3]);
  const auto d2 = depth_at(p[4], p[5]);
  const auto least = hn::Min(hn::Min(d0, d1), d2);
  const auto range = hn::Sub(hn::Max(hn::Max(d0, d1), d2), least);
  const auto length = hn::Max(b.width_px, b.height_px);
  const auto is_thin = hn::Lt(area, hn::Mul(length, hn::Set(df, thin)));
  const auto excess =
      hn::IfThenElse(is_thin, hn::Set(df, sliver_excess), hn::Set(df, excess_of_thick));
  const auto biases = TwoBiases(b);
  const auto fit =
      hn::And(hn::Gt(hn::Mul(area, hn::Set(df, sliver_reach)), hn::Mul(biases, length)),
              hn::Ge(hn::Mul(area, hn::Mul(least, excess)), hn::Mul(biases, range)));
  return hn::Not(fit);
}

/// Draws the slivers among up to kStep survivors, and has their records, of which `base` are the
/// first values, draw nothing. It makes all from the beginning: only few come here, and what SetUp
/// would hand over would be kept in memory for all.
HWY_NOINLINE void TakeOutSlivers(const FrameContext& frame, std::size_t start, std::size_t count,
                                 const Scratch& s, const Target& target, float* base) {
  std::array<VF, 6> p;
  for (std::size_t j = 0; j < p.size(); ++j) p[j] = hn::LoadU(df, &s.survivor_pixels[j][start]);
  const Boxes b = BoundBlocks(p, frame.view->intrinsics, target.lanes_per_row);
  const EdgeFunction first = MakeEdge(p[0], p[1], p[2], p[3], b);
  const EdgeFunction last = MakeEdge(p[4], p[5], p[0], p[1], b);
  const DepthPlanes z = MakeDepthPlanes(frame, s, start, count, b);
  std::uint32_t bits = Bits(AreSlivers(p, b, TwiceArea(first, last), z)) & ((1U << count) - 1);
  for (; bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(bits));
    base[4 * i] = -1e20F;
    DrawSliver(frame, s, start + i, target);
  }
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
  const std::uint32_t tame = Bits(AreTame(p, b, TwiceArea(e0, e2), z));
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
  if (HWY_UNLIKELY((~tame & ((1U << count) - 1)) != 0)) {
    TakeOutSlivers(frame, start, count, s, target, base);
  }
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

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#endif  // PENUMBRA_RENDER_CPU_SETUP_INL
