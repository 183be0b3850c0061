// SPDX-License-Identifier: Apache-2.0
// Compiled per SIMD target: vectors of pixels, and a rule as such vectors.
#if defined(PENUMBRA_LABEL_VECTORS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_LABEL_VECTORS_INL
#undef PENUMBRA_LABEL_VECTORS_INL
#else
#define PENUMBRA_LABEL_VECTORS_INL
#endif

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <penumbra/labels/label_work-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 8>;  // no wider: spans are narrow
using I = hn::RebindToSigned<F>;
using S = hn::Repartition<std::int16_t, F>;
using B = hn::Repartition<std::int8_t, F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using VB = hn::Vec<B>;

constexpr int lanes = static_cast<int>(hn::MaxLanes(F()));
constexpr int chunk = 4 * lanes;  // pixels: as many as a vector has bytes; divides a tile

HWY_INLINE VF load_metres(const float* depth) { return hn::LoadU(F(), depth); }

HWY_INLINE VF load_metres(const std::uint16_t* depth) {
  const hn::Rebind<std::uint16_t, F> narrow;
  const VI millimetres = hn::PromoteTo(I(), hn::LoadU(narrow, depth));
  return hn::Mul(hn::ConvertTo(F(), millimetres), hn::Set(F(), metres_per_millimetre));
}

/// A Rule in vectors.
struct Criteria {
  HWY_INLINE Criteria(const Rule& rule, const float* /*depth*/)
      : Criteria(rule, rule.range.near, rule.range.far) {}
  HWY_INLINE Criteria(const Rule& rule, const std::uint16_t* /*depth*/)
      : Criteria(rule, metres_per_millimetre * static_cast<float>(rule.range.first),
                 metres_per_millimetre * static_cast<float>(rule.range.last)) {}
  HWY_INLINE Criteria(const Rule& rule, float near, float far)
      : a(hn::Set(F(), rule.a)),
        b(hn::Set(F(), rule.b)),
        c(hn::Set(F(), rule.c)),
        beyond_factor(hn::Set(F(), rule.beyond_factor)) {
    const auto near_bits = std::bit_cast<std::uint32_t>(near);
    const auto far_bits = std::bit_cast<std::uint32_t>(far);
    const std::uint32_t count = far_bits < near_bits ? 0 : far_bits - near_bits + 1;
    first = hn::Set(I(), static_cast<std::int32_t>(near_bits + sign));
    end = hn::Set(I(), static_cast<std::int32_t>(count + sign));
  }

  HWY_INLINE VF tolerance(VF z) const { return hn::Add(a, hn::Mul(hn::Add(b, hn::Mul(c, z)), z)); }

  /// Whether near <= d <= far. The bits of positive floats have the order of the floats, and those
  /// of all others, as unsigned numbers, are larger: one unsigned comparison, done as a signed one
  /// of numbers shifted by 2^31.
  HWY_INLINE hn::Mask<I> measured(VF d) const {
    return hn::Gt(end, hn::Sub(hn::BitCast(I(), d), first));
  }

  VF a, b, c, beyond_factor;

 private:
  static constexpr std::uint32_t sign = 0x80000000u;
  VI first, end;
};

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#endif
