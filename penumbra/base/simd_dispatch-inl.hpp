// SPDX-License-Identifier: Apache-2.0
// For sources that are compiled per target: include under HWY_ONCE, after hwy/highway.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

namespace penumbra {

/// Returns the index of a target in the tables of HWY_EXPORT in this translation unit. Unlike
/// HWY_DYNAMIC_DISPATCH, which uses one global target, every instance can have its own.
[[nodiscard]] inline std::size_t simd_table_index(std::int64_t target) {
  hwy::ChosenTarget chosen;
  chosen.Update(target);
  return chosen.GetIndex();
}

}  // namespace penumbra

/// The function `name`, exported with HWY_EXPORT, for `target` (a bit of simd_target).
#if HWY_IDE || ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0)
#define PENUMBRA_SIMD_FUNCTION(name, target) (static_cast<void>(target), &HWY_STATIC_DISPATCH(name))
#else
#define PENUMBRA_SIMD_FUNCTION(name, target) \
  (HWY_DISPATCH_TABLE(name)[penumbra::simd_table_index(target)])
#endif
