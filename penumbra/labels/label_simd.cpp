// SPDX-License-Identifier: Apache-2.0
// Compiled once per SIMD target. Without fused multiply-add, so that all targets give the same
// labels.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "penumbra/labels/label_simd.cpp"
#include <hwy/foreach_target.h>
//
#include <variant>

#include <hwy/highway.h>

#include <penumbra/labels/foreground_pixels-inl.hpp>
#include <penumbra/labels/front_cleanup-inl.hpp>
#include <penumbra/labels/pixel_labels-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {

template <typename T>
Counts label_image(Work& work, ImageView<const float> virtual_depth, ImageView<const T> measured) {
  Counts counts{};
  if (!work.rule.cleans_up()) {
    label_tiles<false>(work, virtual_depth, measured, counts);
    return counts;
  }
  label_tiles<true>(work, virtual_depth, measured, counts);
  if (!any(work.front_tiles)) return counts;
  find_foreground(work, work.front_tiles, virtual_depth, measured);
  work.mark_rim();
  find_foreground(work, work.rim_tiles, virtual_depth, measured);
  const std::size_t dropped = drop_isolated(work);
  counts[static_cast<std::size_t>(Label::front)] -= dropped;
  counts[static_cast<std::size_t>(Label::occluded)] += dropped;
  return counts;
}

Counts label_any(Work& work, ImageView<const float> virtual_depth, const DepthView& measured) {
  return std::visit([&](const auto& depth) { return label_image(work, virtual_depth, depth); },
                    measured);
}

LabelKernel labelling_kernel() { return label_any; }

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <penumbra/base/simd_dispatch-inl.hpp>

namespace penumbra::labelling {
namespace {
HWY_EXPORT(labelling_kernel);
}

LabelKernel label_kernel(std::int64_t target) {
  return PENUMBRA_SIMD_FUNCTION(labelling_kernel, target)();
}

}  // namespace penumbra::labelling
#endif
