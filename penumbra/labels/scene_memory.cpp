// SPDX-License-Identifier: Apache-2.0
// Compiled once per SIMD target. All targets remember the same.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "penumbra/labels/scene_memory.cpp"
#include <hwy/foreach_target.h>
//
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>
#include <variant>

#include <hwy/highway.h>

#include <penumbra/base/stamps.hpp>
#include <penumbra/labels/fringe-inl.hpp>
#include <penumbra/labels/label_vectors-inl.hpp>
#include <penumbra/labels/scene_memory.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {

/// Metres of what is known.
HWY_INLINE VF metres_known(VI known) {
  return hn::Mul(hn::ConvertTo(F(), hn::And(known, hn::Set(I(), seen_once - 1))),
                 hn::Set(F(), metres_per_millimetre));
}

/// Calls f(measured, robot, known, is_first_row) for `lanes` pixels at a time.
template <typename T, typename Function>
HWY_INLINE void for_each_vector(const SceneTile& tile, ImageView<const float> robot,
                                ImageView<const T> measured, Function&& f) {
  for (int v = tile.v0; v < tile.v1; ++v) {
    const T* const in = measured.row(v);
    const float* const z = robot.row(v);
    std::uint16_t* const known = tile.known.row(v);
    int u = tile.u0;
    for (; u + lanes <= tile.u1; u += lanes) f(in + u, z + u, known + u, v == tile.v0);
    if (u == tile.u1) continue;
    std::array<T, lanes> cut{};  // the image ends inside of a vector
    std::array<float, lanes> cut_z{};
    std::array<std::uint16_t, lanes> cut_known{};
    std::copy(in + u, in + tile.u1, cut.begin());
    std::copy(z + u, z + tile.u1, cut_z.begin());
    std::copy(known + u, known + tile.u1, cut_known.begin());
    f(cut.data(), cut_z.data(), cut_known.data(), v == tile.v0);
    std::copy_n(cut_known.begin(), tile.u1 - u, known + u);
  }
}

template <typename T>
bool take_tile(const Rule& rule, const SceneTile& tile, ImageView<const float> robot,
               ImageView<const T> measured) {
  const Criteria criteria(rule, measured.data);
  const hn::Rebind<std::uint16_t, F> narrow;
  const VI none = hn::Set(I(), SceneMemory::none);
  const VI once = hn::Set(I(), tile.is_new ? 0 : seen_once);
  std::size_t both = 0, others = 0;
  const auto take = [&](const T* in, const float*, std::uint16_t* known, bool is_first) HWY_ATTR {
    const VF d = load_metres(in);
    const auto is_measured = criteria.measured(d);
    const VI before = hn::PromoteTo(I(), hn::LoadU(narrow, known));
    const auto is_both = hn::And(hn::RebindMask(I(), is_measured), hn::Ne(before, none));
    const VF off = hn::Abs(hn::Sub(d, metres_known(before)));
    const auto is_same = hn::And(is_both, hn::RebindMask(I(), hn::Le(off, criteria.tolerance(d))));
    if (is_first) {
      both += hn::CountTrue(I(), is_both);
      others += hn::CountTrue(I(), hn::AndNot(is_same, is_both));
    }
    const VI now = hn::NearestInt(hn::Mul(d, hn::Set(F(), millimetres_per_metre)));
    const VI marked = hn::IfThenElse(is_same, now, hn::Or(now, once));
    const auto fits =
        hn::And(hn::RebindMask(I(), is_measured), hn::Lt(now, hn::Set(I(), seen_once)));
    hn::StoreU(hn::DemoteTo(narrow, hn::IfThenElse(fits, marked, none)), narrow, known);
  };
  for_each_vector(tile, robot, measured, take);
  return 2 * others > both;
}

template <typename T>
void check_tile(const Rule& rule, const SceneTile& tile, ImageView<const float> robot,
                ImageView<const T> measured) {
  const Criteria criteria(rule, measured.data);
  const hn::Rebind<std::uint16_t, F> narrow;
  const VF reach = hn::Set(F(), static_cast<float>(LabelRule::fringe_drift));
  const VF step = hn::Set(F(), static_cast<float>(LabelRule::fringe_step));
  const auto check = [&](const T* in, const float* virtual_depth, std::uint16_t* known,
                         bool) HWY_ATTR {
    const VI before = hn::PromoteTo(I(), hn::LoadU(narrow, known));
    const VF d = load_metres(in), z = hn::LoadU(F(), virtual_depth), m = metres_known(before);
    const VF e = criteria.tolerance(m);
    const auto is_past =
        hn::And(hn::RebindMask(F(), criteria.measured(d)), hn::Gt(hn::Sub(d, m), hn::Mul(step, e)));
    const auto is_reached =
        hn::And(hn::Gt(z, hn::Zero(F())), hn::Le(hn::Abs(hn::Sub(z, m)), hn::Mul(reach, e)));
    const VI now = hn::IfThenElse(hn::RebindMask(I(), hn::Or(is_past, is_reached)),
                                  hn::Set(I(), SceneMemory::none), before);
    hn::StoreU(hn::DemoteTo(narrow, now), narrow, known);
  };
  for_each_vector(tile, robot, measured, check);
}

bool update_tile(const Rule& rule, const SceneTile& tile, ImageView<const float> robot,
                 const DepthView& measured) {
  return std::visit(
      [&](const auto& depth) {
        if (!tile.is_near) return take_tile(rule, tile, robot, depth);
        check_tile(rule, tile, robot, depth);
        return false;
      },
      measured);
}

UpdateSceneTile scene_kernel() { return update_tile; }

}  // namespace HWY_NAMESPACE
}  // namespace penumbra::labelling
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <penumbra/base/simd_dispatch-inl.hpp>
#include <penumbra/base/simd_target.hpp>

namespace penumbra {
namespace labelling {
namespace {
HWY_EXPORT(scene_kernel);
}
}  // namespace labelling

namespace {

constexpr std::int64_t period = 250'000'000;  // ns between visits of a row of tiles
constexpr int least_reach = 40;               // pixels: what is nearer to it is near
constexpr double same_place = 1e-3;           // metres, radians: the camera stands still

/// Returns the tiles of a row in which the robot is, of those that the renderer has touched.
std::uint64_t robot_tiles(const VirtualDepthView& robot, std::size_t row) {
  const TileMask& touched = *robot.touched;
  const int v0 = static_cast<int>(row) * TileMask::tile_height;
  const int v1 = std::min(v0 + TileMask::tile_height, touched.height);
  const auto is_robot = [](float z) { return z > 0.0f; };
  std::uint64_t found = 0;
  for (std::uint64_t bits = touched.rows[row]; bits != 0; bits &= bits - 1) {
    const int u0 = std::countr_zero(bits) * touched.tile_width;
    const int u1 = std::min(u0 + touched.tile_width, touched.width);
    for (int v = v0; v < v1; ++v) {
      if (!std::any_of(robot.depth.row(v) + u0, robot.depth.row(v) + u1, is_robot)) continue;
      found |= bits & -bits;
      break;
    }
  }
  return found;
}

labelling::UpdateSceneTile update_tile(std::int64_t target) {
  using namespace labelling;
  return PENUMBRA_SIMD_FUNCTION(scene_kernel, target)();
}

}  // namespace

SceneMemory::SceneMemory(int width, int height, const LabelRule& rule, const std::string& isa)
    : rule_(rule),
      update_tile_(penumbra::update_tile(simd_target(isa))),
      reach_(std::max(rule.fringe_reach, least_reach)),
      lasts_(static_cast<std::uint64_t>(1e9 * rule.scene_memory)),
      depth_(width, height, none),
      robot_(width, height),
      known_(robot_.rows.size()),
      taken_(known_.size()) {}

void SceneMemory::forget() {
  if (!is_empty_) std::fill_n(depth_.data(), depth_.size(), none);
  std::fill(known_.begin(), known_.end(), 0);
  away_ = changed_ = 0;
  is_empty_ = true;
}

void SceneMemory::update(const Eigen::Isometry3d& T_root_camera, std::int64_t stamp,
                         const VirtualDepthView& robot, const DepthView& measured) {
  const Eigen::Isometry3d before = T_root_camera_.value_or(T_root_camera);
  const bool is_moving = (T_root_camera.translation() - before.translation()).norm() > same_place ||
                         (T_root_camera.linear() - before.linear()).norm() > same_place;
  if (is_moving || is_clock_jump(stamp, stamp_)) forget();
  if (is_moving || !T_root_camera_) T_root_camera_ = T_root_camera;
  const std::int64_t last = std::exchange(stamp_, stamp);
  if (is_moving || robot.touched == nullptr) return;
  const std::size_t rows = known_.size();
  const auto reach = static_cast<std::size_t>(reach_) / TileMask::tile_height + 1;
  const auto visit = [&](std::int64_t at, std::size_t row) {  // rows take turns
    return (at / 2 +
            static_cast<std::int64_t>(row) * (period / 2) / static_cast<std::int64_t>(rows)) /
           (period / 2);
  };
  robot_.tile_width = robot.touched->tile_width;
  std::size_t scanned = 0;
  for (std::size_t j = 0; j < rows; ++j) {
    if (!is_empty_ && visit(stamp, j) == visit(last, j)) continue;
    const std::size_t end = std::min(rows, j + reach + 1);
    for (std::size_t i = std::max(scanned, j - std::min(j, reach)); i < end; ++i)
      robot_.rows[i] = robot_tiles(robot, i);
    scanned = end;
    update_row(j, robot, measured);
  }
  is_empty_ = false;
  if (4 * away_ < static_cast<int>(rows) * (depth_.width() / robot_.tile_width + 1)) return;
  if (2 * changed_ > away_) forget();  // as where a base drives
  away_ = changed_ = 0;
}

void SceneMemory::update_row(std::size_t row, const VirtualDepthView& robot,
                             const DepthView& measured) {
  const std::uint64_t near = labelling::marked_around(robot_, row, reach_);
  labelling::SceneTile tile{.v0 = static_cast<int>(row) * TileMask::tile_height,
                            .known = depth_.view()};
  tile.v1 = std::min(tile.v0 + TileMask::tile_height, depth_.height());
  for (std::size_t i = 0; tile.u0 < depth_.width(); ++i, tile.u0 = tile.u1) {
    tile.u1 = std::min(tile.u0 + robot_.tile_width, depth_.width());
    const std::uint64_t bit = std::uint64_t{1} << i;
    const bool is_known = (known_[row] & bit) != 0;
    const std::uint64_t age = stamp_distance(stamp_, taken_[row].at(i));
    tile.is_near = (near & bit) != 0;
    tile.is_new = !is_known;
    if (tile.is_near && !is_known) continue;
    if (tile.is_near && age > lasts_) {
      for (int v = tile.v0; v < tile.v1; ++v)
        std::fill(&depth_(tile.u0, v), &depth_(tile.u0, v) + (tile.u1 - tile.u0), none);
      known_[row] &= ~bit;
      continue;
    }
    const bool is_other = update_tile_(rule_, tile, robot.depth, measured);
    if (tile.is_near) continue;
    away_ += is_known;
    changed_ += is_other && is_known;
    taken_[row].at(i) = stamp_;
    known_[row] |= bit;
  }
}

}  // namespace penumbra
#endif
