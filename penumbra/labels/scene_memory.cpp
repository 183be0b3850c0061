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
#include <span>
#include <variant>

#include <hwy/highway.h>

#include <penumbra/labels/fringe-inl.hpp>
#include <penumbra/labels/label_vectors-inl.hpp>
#include <penumbra/labels/scene_memory.hpp>

HWY_BEFORE_NAMESPACE();
namespace penumbra::labelling {
namespace HWY_NAMESPACE {

HWY_INLINE hn::Mask<F> differ(VF a, VF b, VF by) { return hn::Gt(hn::Abs(hn::Sub(a, b)), by); }

/// Calls f(measured, robot, labels, known, is_first_row) for `lanes` pixels at a time.
template <typename T, typename Function>
HWY_INLINE void for_each_vector(const SceneTile& tile, ImageView<const T> measured, Function&& f) {
  const auto at = [](const auto& image, int u, int v) { return image.row(v) + u; };
  for (int v = tile.v0; v < tile.v1; ++v) {
    int u = tile.u0;
    for (; u + lanes <= tile.u1; u += lanes)
      f(at(measured, u, v), at(tile.robot, u, v), at(tile.labels, u, v), at(tile.known, u, v),
        v == tile.v0);
    if (u == tile.u1) continue;
    std::array<T, lanes> depth{};  // the image ends inside of a vector
    std::array<float, lanes> robot{};
    std::array<std::uint8_t, lanes> labels{};
    std::array<std::uint16_t, lanes> known{};
    std::copy(at(measured, u, v), at(measured, tile.u1, v), depth.begin());
    std::copy(at(tile.robot, u, v), at(tile.robot, tile.u1, v), robot.begin());
    std::copy(at(tile.labels, u, v), at(tile.labels, tile.u1, v), labels.begin());
    std::copy(at(tile.known, u, v), at(tile.known, tile.u1, v), known.begin());
    f(depth.data(), robot.data(), labels.data(), known.data(), v == tile.v0);
    std::copy_n(known.begin(), tile.u1 - u, at(tile.known, u, v));
  }
}

template <typename T>
bool take_tile(const Rule& rule, const SceneTile& tile, ImageView<const T> measured) {
  const Criteria criteria(rule, measured.data);
  const hn::Rebind<std::uint16_t, F> narrow;
  std::size_t both = 0, others = 0;
  const auto take = [&](const T* depth, const float*, const std::uint8_t*, std::uint16_t* known,
                        bool is_first_row) HWY_ATTR {
    const VF d = load_metres(depth);
    const auto is_measured = criteria.measured(d);
    const VI before = hn::PromoteTo(I(), hn::LoadU(narrow, known));
    if (is_first_row) {
      const auto is_both = hn::RebindMask(
          F(), hn::And(is_measured, hn::Ne(before, hn::Set(I(), SceneMemory::none))));
      const auto is_other = differ(d, load_metres(known), criteria.tolerance(d));
      both += hn::CountTrue(F(), is_both);
      others += hn::CountTrue(F(), hn::And(is_both, is_other));
    }
    const VI now = hn::NearestInt(hn::Mul(d, hn::Set(F(), millimetres_per_metre)));
    hn::StoreU(hn::DemoteTo(narrow, hn::IfThenElse(is_measured, now, before)), narrow, known);
  };
  for_each_vector(tile, measured, take);
  return 2 * others > both;
}

template <typename T>
void check_tile(const Rule& rule, const SceneTile& tile, ImageView<const T> measured) {
  const Criteria criteria(rule, measured.data);
  const hn::Rebind<std::uint16_t, F> narrow;
  const hn::Rebind<std::uint8_t, F> bytes;
  const VF reach = hn::Set(F(), static_cast<float>(LabelRule::fringe_drift));
  const VF step = hn::Set(F(), static_cast<float>(LabelRule::fringe_step));
  const auto check = [&](const T* depth, const float* robot, const std::uint8_t* labels,
                         std::uint16_t* known, bool) HWY_ATTR {
    const VF d = load_metres(depth), z = hn::LoadU(F(), robot), m = load_metres(known);
    const VF e = criteria.tolerance(m);
    const VI label = hn::PromoteTo(I(), hn::LoadU(bytes, labels));
    const auto is_clear = hn::Eq(label, hn::Set(I(), static_cast<int>(Label::clear)));
    const auto is_other = hn::And(hn::RebindMask(F(), hn::And(is_clear, criteria.measured(d))),
                                  differ(d, m, hn::Mul(step, e)));
    const auto is_reached = hn::AndNot(differ(z, m, hn::Mul(reach, e)), hn::Gt(z, hn::Zero(F())));
    const VI before = hn::PromoteTo(I(), hn::LoadU(narrow, known));
    const VI now = hn::IfThenElse(hn::RebindMask(I(), hn::Or(is_other, is_reached)),
                                  hn::Set(I(), SceneMemory::none), before);
    hn::StoreU(hn::DemoteTo(narrow, now), narrow, known);
  };
  for_each_vector(tile, measured, check);
}

bool update_tile(const Rule& rule, const SceneTile& tile, const DepthView& measured) {
  return std::visit(
      [&](const auto& depth) {
        if (!tile.is_near) return take_tile(rule, tile, depth);
        check_tile(rule, tile, depth);
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

constexpr std::int64_t period = 2'000'000'000;  // ns from one visit of a row of tiles to the next
constexpr std::size_t parts = 64;               // that are visited one after the other
constexpr double same_place = 1e-3;             // metres, radians: the camera stands still

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
      reach_(rule.fringe_reach),
      lasts_(static_cast<std::int64_t>(1e9 * rule.scene_memory)),
      depth_(width, height, none),
      robot_(width, height),
      visited_(robot_.rows.size()),
      known_(visited_.size()),
      taken_(visited_.size()) {}

void SceneMemory::forget() {
  if (!is_empty_) std::fill_n(depth_.data(), depth_.size(), none);
  std::fill(known_.begin(), known_.end(), 0);
  is_empty_ = true;
}

void SceneMemory::begin(const Eigen::Isometry3d& T_root_camera, std::optional<std::int64_t> stamp) {
  const Eigen::Isometry3d before = T_root_camera_.value_or(T_root_camera);
  is_moving_ = (T_root_camera.translation() - before.translation()).norm() > same_place ||
               (T_root_camera.linear() - before.linear()).norm() > same_place;
  const bool is_set = stamp && stamp_ && (*stamp < *stamp_ || *stamp - *stamp_ > lasts_);
  if (is_moving_ || is_set) forget();
  if (is_moving_ || !T_root_camera_) T_root_camera_ = T_root_camera;
  if (stamp) stamp_ = stamp;
}

void SceneMemory::update(const VirtualDepthView& virtual_depth, const DepthView& measured,
                         const LabelView& labels) {
  if (is_moving_ || virtual_depth.touched == nullptr) return;
  const std::int64_t now = stamp_.value_or(0);
  const auto is_due = [&](std::int64_t visited) {
    return !stamp_ || is_empty_ || now - visited >= period;
  };
  const std::size_t rows = visited_.size();
  int away = 0, changed = 0;  // tiles
  const auto reach = static_cast<std::size_t>(reach_ / TileMask::tile_height + 1);
  robot_.tile_width = virtual_depth.touched->tile_width;
  for (std::size_t j = 0; j < rows; ++j) {
    if (!is_due(visited_[j])) continue;
    const std::size_t end = std::min(rows, j + reach + 1);
    for (std::size_t i = j - std::min(j, reach); i < end; ++i)
      robot_.rows[i] = robot_tiles(virtual_depth, i);
    visited_[j] = is_empty_ ? now - static_cast<std::int64_t>(j % parts) * period / parts : now;
    const std::uint64_t near = labelling::marked_around(robot_, j, reach_);
    labelling::SceneTile tile{.v0 = static_cast<int>(j) * TileMask::tile_height,
                              .robot = virtual_depth.depth,
                              .labels = labels.labels,
                              .known = depth_.view()};
    tile.v1 = std::min(tile.v0 + TileMask::tile_height, depth_.height());
    for (std::size_t i = 0; tile.u0 < depth_.width(); ++i, tile.u0 = tile.u1) {
      tile.u1 = std::min(tile.u0 + robot_.tile_width, depth_.width());
      const std::uint64_t bit = std::uint64_t{1} << i;
      tile.is_near = (near & bit) != 0;
      if (tile.is_near && (known_[j] & bit) == 0) continue;
      if (tile.is_near && now - taken_[j].at(i) > lasts_) {
        for (int v = tile.v0; v < tile.v1; ++v)
          std::fill(&depth_(tile.u0, v), &depth_(tile.u0, v) + (tile.u1 - tile.u0), none);
        known_[j] &= ~bit;
        continue;
      }
      changed += update_tile_(rule_, tile, measured);
      if (tile.is_near) continue;
      ++away;
      taken_[j].at(i) = now;
      known_[j] |= bit;
    }
  }
  const bool is_elsewhere = !is_empty_ && 2 * changed > away;  // as of a base that drives
  is_empty_ = false;
  if (is_elsewhere) forget();
}

}  // namespace penumbra
#endif
