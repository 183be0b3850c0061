// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <penumbra/labels/label_work-inl.hpp>

namespace penumbra::labelling {
namespace {

enum Mark : std::uint8_t { front = 1, certain = 2, unmeasured = 4, solid = 8, seed = 16 };

constexpr float infinity = std::numeric_limits<float>::infinity();

float tolerance(const Rule& rule, float z) { return rule.a + (rule.b + rule.c * z) * z; }

bool is_measurement(const Rule& rule, float d) {
  return rule.metres.near <= d && d <= rule.metres.far;
}
bool is_measurement(const Rule& rule, std::uint16_t d) {
  return d != saturated_depth && is_measurement(rule, static_cast<float>(d / 1000.0));
}

template <typename T>
Label label_of(const Rule& rule, float z, T measured) {
  if (!(z > 0.0f)) return Label::clear;
  if (!is_measurement(rule, measured)) return Label::unknown;
  const float d = metres(measured);
  const float e = tolerance(rule, z);
  if (d < z - e) return Label::front;
  if (d > z + rule.beyond_factor * e) return Label::beyond;
  return Label::occluded;
}

void fill_cells(Work& work, ImageView<const float> virtual_depth) {
  work.cells.clear(0, work.width, 0, work.height);
  for (int v = 0; v < work.height; ++v) {
    for (int u = 0; u < work.width; ++u) {
      float& cell = work.cells.row(v / LabelRule::cell)[u / LabelRule::cell];
      if (virtual_depth(u, v) > 0.0f) cell = std::min(cell, virtual_depth(u, v));
    }
  }
}

/// Whether the measured depth d of pixel (u, v) lies before all of the robot around.
bool is_certain(Work& work, int u, int v, float d) {
  float nearest = infinity;
  const int reach = work.rule.cells;
  for (int j = v / LabelRule::cell - reach; j <= v / LabelRule::cell + reach; ++j)
    for (int i = u / LabelRule::cell - reach; i <= u / LabelRule::cell + reach; ++i)
      nearest = std::min(nearest, work.cells.row(j)[i]);
  return nearest < infinity && d < nearest - tolerance(work.rule, nearest);
}

/// Whether a pixel at most `reach` steps of (du, dv) from (u, v) has the mark.
bool marked_along(const Work& work, int u, int v, int du, int dv, Mark mark) {
  for (int i = 1; i <= work.rule.width; ++i) {
    const int x = u + i * du, y = v + i * dv;
    if (x < 0 || y < 0 || x >= work.width || y >= work.height) return false;
    if ((work.marks(x, y) & mark) != 0) return true;
  }
  return false;
}

/// Marks as solid what counts as certain: pixels that are, and unmeasured ones between them.
void mark_solid(Work& work) {
  for (int v = 0; v < work.height; ++v) {
    for (int u = 0; u < work.width; ++u) {
      const auto seen = [&](int du, int dv) { return marked_along(work, u, v, du, dv, certain); };
      std::uint8_t& marks = work.marks(u, v);
      const bool hole =
          (marks & unmeasured) != 0 && ((seen(-1, 0) && seen(1, 0)) || (seen(0, -1) && seen(0, 1)));
      if ((marks & certain) != 0 || hole) marks |= solid;
    }
  }
}

/// Marks as seeds what is front and certain in the square with the corner (u, v), if it is solid.
void mark_seeds(Work& work, int u, int v) {
  const int width = work.rule.width;
  for (int y = v; y < v + width; ++y)
    for (int x = u; x < u + width; ++x)
      if ((work.marks(x, y) & solid) == 0) return;
  for (int y = v; y < v + width; ++y)
    for (int x = u; x < u + width; ++x)
      if ((work.marks(x, y) & front) != 0 && (work.marks(x, y) & certain) != 0)
        work.marks(x, y) |= seed;
}

bool is_confirmed(const Work& work, int u, int v) {
  const int reach = work.rule.reach;
  for (int y = std::max(0, v - reach); y <= std::min(work.height - 1, v + reach); ++y)
    for (int x = std::max(0, u - reach); x <= std::min(work.width - 1, u + reach); ++x)
      if ((work.marks(x, y) & seed) != 0) return true;
  return false;
}

template <typename T>
void clean_up(Work& work, ImageView<const float> virtual_depth, ImageView<const T> measured) {
  if (work.rule.cells > 0) fill_cells(work, virtual_depth);
  for (int v = 0; v < work.height; ++v) {
    for (int u = 0; u < work.width; ++u) {
      const T d = measured(u, v);
      const bool is_front = work.labels(u, v) == static_cast<std::uint8_t>(Label::front);
      std::uint8_t marks = is_front ? front : 0;
      if (!is_measurement(work.rule, d))
        marks |= unmeasured;
      else if (work.rule.cells > 0 ? is_certain(work, u, v, metres(d)) : is_front)
        marks |= certain;
      work.marks(u, v) = marks;
    }
  }
  mark_solid(work);
  for (int v = 0; v + work.rule.width <= work.height; ++v)
    for (int u = 0; u + work.rule.width <= work.width; ++u) mark_seeds(work, u, v);
  for (int v = 0; v < work.height; ++v)
    for (int u = 0; u < work.width; ++u)
      if ((work.marks(u, v) & front) != 0 && !is_confirmed(work, u, v))
        work.labels(u, v) = static_cast<std::uint8_t>(Label::occluded);
}

template <typename T>
Counts label_image(Work& work, ImageView<const float> virtual_depth, ImageView<const T> measured) {
  for (int v = 0; v < work.height; ++v)
    for (int u = 0; u < work.width; ++u)
      work.labels(u, v) =
          static_cast<std::uint8_t>(label_of(work.rule, virtual_depth(u, v), measured(u, v)));
  if (work.rule.cleans_up()) clean_up(work, virtual_depth, measured);
  Counts counts{};
  for (int v = 0; v < work.height; ++v)
    for (int u = 0; u < work.width; ++u) ++counts[work.labels(u, v)];
  counts[static_cast<std::size_t>(Label::clear)] = 0;
  return counts;
}

}  // namespace

Kernels scalar_kernels() { return {label_image<std::uint16_t>, label_image<float>}; }

}  // namespace penumbra::labelling
