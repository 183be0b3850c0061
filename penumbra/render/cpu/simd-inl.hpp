// SPDX-License-Identifier: Apache-2.0
// Vectors of one SIMD target, and small helpers on them.
#if defined(PENUMBRA_RENDER_CPU_SIMD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_RENDER_CPU_SIMD_INL
#undef PENUMBRA_RENDER_CPU_SIMD_INL
#else
#define PENUMBRA_RENDER_CPU_SIMD_INL
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <penumbra/render/cpu/frame.hpp>

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

// Of the bias of edge functions: MakeEdge.
constexpr float edge_margin = 48.0F;  // pixels
constexpr float edge_rounding = 0x1p-21F;

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

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::cpu
HWY_AFTER_NAMESPACE();

#endif  // PENUMBRA_RENDER_CPU_SIMD_INL
