// SPDX-License-Identifier: Apache-2.0
// The renderer's kernel, compiled once per SIMD target.
//
// A frame's clusters, those of the nearest groups first, go through: cull (bounding spheres against
// the view), front faces (planes against the camera's centre), project (vertices), hide (what is
// drawn already), select (triangles that may cover a pixel centre), set up (edge functions and
// depth planes, sorted by size into bins), fill (one unrolled routine per size), resolve (packed
// 1/z to depth and link images).
//
// Edge functions are those of Pineda 1988, "A parallel algorithm for polygon rasterization". They
// get a bias above their rounding error, 5e-7 of the triangle's size, so that a pixel on a
// shared edge belongs to one of its triangles at least. The depth buffer takes the maximum of 1/z:
// covering a pixel twice is harmless.
#include <penumbra/render/cpu/kernel.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "penumbra/render/cpu/kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once for each target:
#include <penumbra/render/cpu/resolve-inl.hpp>
#include <penumbra/render/cpu/select-inl.hpp>
#include <penumbra/render/cpu/setup-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::cpu {
namespace HWY_NAMESPACE {

/// Takes one cluster up to the survivors.
void Collect(const FrameContext& frame, const DrawItem& item, Scratch& s, Canvas& canvas) {
  const ClusteredScene& scene = *frame.scene;
  const Cluster& cluster = scene.clusters[item.cluster];
  const BodyFrame& body = frame.bodies[item.body];
  const std::uint32_t* corners = &scene.corners[cluster.first_triangle];
  const std::span<const Bounds> holes = Holes(frame, item);
  Bounds bounds{};
  if (!holes.empty()) bounds = Project(scene, cluster, body, s.pixels.data());
  const bool both_sides =
      item.sides == Sides::both || (!holes.empty() && (item.clip || MeetsAny(holes, bounds)));
  std::size_t count = both_sides ? FrontFaces<true>(scene, cluster, body, s.front.data())
                                 : FrontFaces<false>(scene, cluster, body, s.front.data());
  if (count == 0) return;
  if (holes.empty()) bounds = Project(scene, cluster, body, s.pixels.data());
  if (IsHidden(bounds, item.nearest, frame.view->intrinsics, canvas)) return;
  if (item.clip) {
    count = ClipCorners(frame, item, count, s, canvas);
  } else {
    if (!MarkTouched(bounds, frame.view->intrinsics, canvas.touched)) return;
    GatherCorners(corners, count, s);
  }
  Select(frame, item, count, s);
}

void Draw(const FrameContext& frame, std::span<const DrawItem> items, Scratch& s, Canvas& canvas) {
  const Target target{canvas.packed.data(), canvas.lanes_per_row,
                      hn::Set(di, ~frame.packing.id_mask)};
  const DrawItem* last = nullptr;
  for (const DrawItem& item : items) {
    const bool is_next = !last || item.group != last->group || item.second != last->second;
    if (is_next || s.survivors > Scratch::max_survivors) SetUpSurvivors(frame, s, target);
    if (is_next) Flush(s, target);
    s.survivor_body = item.body;
    last = &item;
    Collect(frame, item, s, canvas);
  }
  SetUpSurvivors(frame, s, target);
  Flush(s, target);
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