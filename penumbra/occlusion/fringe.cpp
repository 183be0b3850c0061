// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <type_traits>
#include <variant>

#include <hwy/highway.h>

#include <penumbra/occlusion/fringe-inl.hpp>

namespace penumbra::labelling {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Eight = hn::FixedTag<std::uint16_t, 8>;

constexpr auto clear = static_cast<std::uint8_t>(Label::clear);
constexpr auto occluded = static_cast<std::uint8_t>(Label::occluded);
constexpr auto fringe = static_cast<std::uint8_t>(Label::fringe);
static_assert(clear == 0);  // painted over by or

constexpr std::size_t room = 16;  // elements that whole vectors may run over a row's end
constexpr float millimetres_per_metre = 1000.0f;
constexpr std::uint16_t is_open = 0x8000;   // a flag at the depth of a clear block
constexpr std::uint16_t farthest = 0x7ffe;  // millimetres; a robot that is farther has no fringe
constexpr std::uint16_t nothing = 0xffff;

std::uint16_t millimetres(std::uint16_t depth) { return depth; }

/// Rounded; 0 where it is not in (0, farthest].
std::uint16_t millimetres(float depth) {
  const float rounded = depth * millimetres_per_metre + 0.5f;
  return rounded > 0.0f && rounded < farthest + 1.0f ? static_cast<std::uint16_t>(rounded)
                                                     : std::uint16_t{0};
}

/// A piece of a row, `count` <= 16 pixels long, as whole vectors may read it.
struct Piece {
  template <typename T>
  Piece(const std::uint8_t* row_labels, const T* row_depth, int count) {
    if constexpr (std::is_same_v<T, std::uint16_t>)
      if (count == 16) {
        labels = row_labels;
        depth = row_depth;
        return;
      }
    own_labels.fill(0);
    own_depth.fill(0);
    for (int i = 0; i < count; ++i) {
      own_labels[static_cast<std::size_t>(i)] = row_labels[i];
      own_depth[static_cast<std::size_t>(i)] = millimetres(row_depth[i]);
    }
  }

  std::array<std::uint8_t, 16> own_labels;
  std::array<std::uint16_t, 16> own_depth;
  const std::uint8_t* labels = own_labels.data();
  const std::uint16_t* depth = own_depth.data();
};

}  // namespace

FringeFill::FringeFill(int width, int height, int reach)
    : reach_(reach),
      pitch_(static_cast<std::size_t>(width + 1) / 2 + room),
      reachable_(width, height) {
  if (reach == 0) return;
  blocks_.resize(pitch_ * static_cast<std::size_t>((height + 1) / 2 + 2) + room);
  sources_.reserve(blocks_.size());
  queue_ = std::make_unique_for_overwrite<Block[]>(blocks_.size() + 1);
}

void FringeFill::add_source(const Rule& rule, int x, int y, std::uint16_t depth) {
  const float z = static_cast<float>(depth) / millimetres_per_metre;
  const float e =
      std::min((rule.a + (rule.b + rule.c * z) * z) * millimetres_per_metre, float{farthest});
  const auto drift = static_cast<int>(static_cast<float>(LabelRule::fringe_drift) * e);
  const auto step = static_cast<int>(static_cast<float>(LabelRule::fringe_step) * e);
  const auto at_x = static_cast<std::int16_t>(x), at_y = static_cast<std::int16_t>(y);
  queue_[sources_.size()] = {at_x, at_y, static_cast<std::uint32_t>(sources_.size()), depth};
  sources_.push_back({static_cast<std::uint16_t>(std::max(depth - drift, 1)),
                      static_cast<std::uint16_t>(std::min<int>(depth + drift, farthest)),
                      static_cast<std::uint16_t>(std::min<int>(step, depth)), at_x, at_y});
}

/// Breadth first, so that each block comes from a near part of the outline. Without branches: which
/// neighbours are taken is hard to predict.
void FringeFill::flood() {
  struct Way {
    std::int16_t x, y;
    std::ptrdiff_t offset;
  };
  const auto pitch = static_cast<std::ptrdiff_t>(pitch_);
  const std::array<Way, 4> ways = {{{0, -1, -pitch}, {-1, 0, -1}, {1, 0, 1}, {0, 1, pitch}}};
  const int goes_on = (reach_ - 1) * (reach_ - 1) / 4;  // blocks, squared
  Block* const queue = queue_.get();
  const Source* const sources = sources_.data();
  std::size_t end = sources_.size();
  for (std::size_t i = 0; i < end; ++i) {
    const Block from = queue[i];
    const Source source = sources[from.source];
    const int dx = from.x - source.x, dy = from.y - source.y;
    if (dx * dx + dy * dy > goes_on) continue;
    const int least = std::max<int>(from.depth - source.step, source.nearest) | is_open;
    const int most = std::min<int>(from.depth + source.step, source.farthest) | is_open;
    std::uint16_t* const here = block(from.x, from.y);
    for (const Way& way : ways) {
      std::uint16_t& next = here[way.offset];
      const bool is_taken = (least <= next) & (next <= most);
      queue[end] = {static_cast<std::int16_t>(from.x + way.x),
                    static_cast<std::int16_t>(from.y + way.y), from.source,
                    static_cast<std::uint16_t>(next - is_open)};
      end += is_taken;
      next = is_taken ? std::uint16_t{0} : next;
    }
  }
  queued_ = end;
}

/// Labels the clear pixels of the queued blocks whose depth is about the block's.
template <typename T>
std::size_t FringeFill::paint(Work& work, ImageView<const T> measured) const {
  const int tile_shift = std::countr_zero(static_cast<unsigned>(work.touched.tile_width));
  // Copies: writes to labels, as bytes, may change any member for all the compiler knows.
  std::uint8_t* const labels = work.labels.data();
  std::uint64_t* const touched = work.touched.rows.data();
  const Block* const queue = queue_.get();
  const Source* const sources = sources_.data();
  const std::size_t queued = queued_;
  const int width = work.width, height = work.height;
  std::size_t count = 0;
  for (std::size_t i = 0; i < queued; ++i) {
    const Block block = queue[i];
    const int off = 2 * sources[block.source].step;
    const int u0 = 2 * block.x, u1 = std::min(u0 + 1, width - 1);
    const int v0 = 2 * block.y, v1 = std::min(v0 + 1, height - 1);
    const auto paint_pixel = [&](int u, int v) {
      std::uint8_t& label = labels[v * width + u];
      const bool is_near = std::abs(millimetres(measured(u, v)) - block.depth) <= off;
      const bool is_fringe = is_near & (label == clear);
      label |= is_fringe ? fringe : std::uint8_t{0};
      count += is_fringe;
    };
    paint_pixel(u0, v0);
    paint_pixel(u1, v0);
    paint_pixel(u0, v1);
    paint_pixel(u1, v1);
    touched[v0 / TileMask::tile_height] |= std::uint64_t{1} << (u0 >> tile_shift);
  }
  return count;
}

}  // namespace penumbra::labelling

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace {

using Vector = hn::VFromD<Eight>;

/// What eight pixels give to their blocks. The least of a block counts: the depth of an occluded
/// one, that of a clear one with is_open, or nothing.
HWY_INLINE Vector ranks(const std::uint8_t* labels, const std::uint16_t* depth, Vector near,
                        Vector far) {
  const hn::Rebind<std::uint8_t, Eight> bytes;
  const auto d = hn::LoadU(Eight(), depth);
  const auto label = hn::PromoteTo(Eight(), hn::LoadU(bytes, labels));
  const auto is_clear = hn::Eq(label, hn::Set(Eight(), clear));
  const auto is_any = hn::And(hn::Or(is_clear, hn::Eq(label, hn::Set(Eight(), occluded))),
                              hn::Eq(hn::Min(hn::Max(d, near), far), d));
  const auto flagged = hn::Or(d, hn::IfThenElseZero(is_clear, hn::Set(Eight(), is_open)));
  return hn::IfThenElse(is_any, flagged, hn::Set(Eight(), nothing));
}

/// The eight blocks of two pieces of rows, one above the other.
HWY_INLINE Vector blocks_of(const Piece& above, const Piece& below, Vector near, Vector far) {
  const auto left = hn::Min(ranks(above.labels, above.depth, near, far),
                            ranks(below.labels, below.depth, near, far));
  const auto right = hn::Min(ranks(above.labels + 8, above.depth + 8, near, far),
                             ranks(below.labels + 8, below.depth + 8, near, far));
  const auto least =
      hn::Min(hn::ConcatEven(Eight(), right, left), hn::ConcatOdd(Eight(), right, left));
  return hn::IfThenZeroElse(hn::Eq(least, hn::Set(Eight(), nothing)), least);
}

}  // namespace

/// In all tiles that the flood may reach.
template <typename T>
void FringeFill::fill_blocks(const Work& work, ImageView<const T> measured) {
  const ImageView<const std::uint8_t> labels = work.labels.view();
  const auto near = hn::Set(Eight(), millimetres(work.rule.millimetres.near));
  const float last = farthest / millimetres_per_metre;
  const auto far = hn::Set(Eight(), millimetres(std::min(work.rule.millimetres.far, last)));
  reachable_.tile_width = work.touched.tile_width;
  for (std::size_t j = 0; j < reachable_.rows.size(); ++j)
    reachable_.rows[j] = marked_around(work.touched, j, reach_);
  reachable_.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int v = v0; v < v1; v += 2) {
      const int below = std::min(v + 1, v1 - 1);
      std::uint16_t* const out = block(0, v / 2);
      for (int u = u0; u < u1; u += 16) {
        const int count = std::min(16, u1 - u);
        const auto blocks =
            blocks_of(Piece(labels.row(v) + u, measured.row(v) + u, count),
                      Piece(labels.row(below) + u, measured.row(below) + u, count), near, far);
        hn::StoreU(blocks, Eight(), out + u / 2);
      }
    }
  });
}

/// Blocks of the robot that have an open one among their eight neighbours.
void FringeFill::find_sources(const Work& work) {
  const auto pitch = static_cast<std::ptrdiff_t>(pitch_);
  const auto row_around = [](const std::uint16_t* at) HWY_ATTR {
    return hn::Or(hn::Or(hn::LoadU(Eight(), at - 1), hn::LoadU(Eight(), at)),
                  hn::LoadU(Eight(), at + 1));
  };
  const auto open = hn::Set(Eight(), is_open);
  work.touched.for_each_span([&](int u0, int u1, int v0, int v1) HWY_ATTR {
    for (int y = v0 / 2; y < (v1 + 1) / 2; ++y)
      for (int x = u0 / 2; x < (u1 + 1) / 2; x += 8) {
        const std::uint16_t* const at = block(x, y);
        const auto around =
            hn::Or(hn::Or(row_around(at - pitch), row_around(at)), row_around(at + pitch));
        const auto here = hn::LoadU(Eight(), at);
        const auto is_robot = hn::And(hn::Lt(here, open), hn::Ne(here, hn::Zero(Eight())));
        std::array<std::uint8_t, 8> bits;  // Highway may write all of them
        hn::StoreMaskBits(Eight(), hn::And(is_robot, hn::TestBit(around, open)), bits.data());
        for (unsigned left = bits[0]; left != 0; left &= left - 1) {
          const int i = std::countr_zero(left);
          add_source(work.rule, x + i, y, at[i]);
        }
      }
  });
}

std::size_t FringeFill::label(Work& work, const DepthView& measured) {
  if (reach_ == 0) return 0;
  sources_.clear();
  return std::visit(
      [&](const auto& depth) {
        fill_blocks(work, depth);
        find_sources(work);
        flood();
        return paint(work, depth);
      },
      measured);
}

}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();
