// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>

#include <penumbra/labels/label_work-inl.hpp>

namespace penumbra::labelling {
namespace {

constexpr int vector_room = 128;  // pixels, for whole vectors at a row's end

int tiles_across(int pixels, int tile) { return (pixels + tile - 1) / tile; }

}  // namespace

std::uint64_t marked_around(const TileMask& tiles, std::size_t j, int pixels) {
  const auto rows = static_cast<std::size_t>(tiles_across(pixels, TileMask::tile_height));
  std::uint64_t bits = 0;
  for (std::size_t i = j - std::min(j, rows); i < std::min(tiles.rows.size(), j + rows + 1); ++i)
    bits |= tiles.rows[i];
  for (int i = tiles_across(pixels, tiles.tile_width); i > 0 && bits != 0; --i)
    bits |= bits << 1 | bits >> 1;
  const int in_image = tiles_across(tiles.width, tiles.tile_width);
  return bits & (~std::uint64_t{0} >> (64 - in_image));
}

Rule::Rule(const LabelRule& rule)
    : a(static_cast<float>(rule.tolerance.a)),
      b(static_cast<float>(rule.tolerance.b)),
      c(static_cast<float>(rule.tolerance.c)),
      beyond_factor(rule.fold_beyond ? std::numeric_limits<float>::infinity()
                                     : static_cast<float>(rule.beyond_factor)),
      range(rule.range.near, rule.range.far),
      width(rule.front_min_width),
      cells((rule.edge_margin + LabelRule::cell - 1) / LabelRule::cell),
      reach(rule.edge_margin / 2) {}

void BitRows::clear(int u0, int u1, int v0, int v1) {
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; u += 32) put(u, v, 0);
}

Cells::Cells(int width, int height, int reach)
    : reach_(reach), pitch_(tiles_across(width, LabelRule::cell) + 2 * reach + spare) {
  const int rows = tiles_across(height, LabelRule::cell) + 2 * reach;
  depth_.assign(static_cast<std::size_t>(pitch_) * static_cast<std::size_t>(rows) + spare,
                std::numeric_limits<float>::infinity());
}

void Cells::clear(int u0, int u1, int v0, int v1) {
  for (int j = v0 / LabelRule::cell; j < tiles_across(v1, LabelRule::cell); ++j)
    std::fill(row(j) + u0 / LabelRule::cell, row(j) + tiles_across(u1, LabelRule::cell),
              std::numeric_limits<float>::infinity());
}

Work::Work(int image_width, int image_height, const Rule& label_rule)
    : rule(label_rule),
      width(image_width),
      height(image_height),
      labels(image_width, image_height),
      touched(image_width, image_height),
      front_tiles(touched),
      foreground_tiles(touched),
      rim_tiles(touched),
      front(image_width, image_height),
      foreground(image_width, image_height),
      unmeasured(image_width, image_height),
      scratch(image_width, image_height),
      cells(image_width, image_height, rule.cells),
      nearest(static_cast<std::size_t>(image_width + 2 * rule.cells + vector_room)),
      limits(static_cast<std::size_t>(image_width + vector_room)),
      cell_tiles_(touched),
      scratch_tiles_(touched) {}

void Work::begin(const TileMask& new_touched) {
  front_tiles.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (BitRows* rows : {&front, &foreground, &unmeasured}) rows->clear(u0, u1, v0, v1);
  });
  rim_tiles.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (BitRows* rows : {&foreground, &unmeasured}) rows->clear(u0, u1, v0, v1);
  });
  cell_tiles_.for_each_span([&](int u0, int u1, int v0, int v1) { cells.clear(u0, u1, v0, v1); });
  TileMask& stale = scratch_tiles_;
  stale = touched;
  if (touched.tile_width == new_touched.tile_width)
    for (std::size_t j = 0; j < stale.rows.size(); ++j) stale.rows[j] &= ~new_touched.rows[j];
  stale.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v)
      std::fill(&labels(u0, v), &labels(u0, v) + (u1 - u0), std::uint8_t{0});
  });
  touched = new_touched;
  for (TileMask* mask :
       {&front_tiles, &foreground_tiles, &rim_tiles, &cell_tiles_, &scratch_tiles_}) {
    mask->tile_width = touched.tile_width;
    std::fill(mask->rows.begin(), mask->rows.end(), std::uint64_t{0});
  }
}

void Work::mark_rim() {
  if (!any(foreground_tiles)) return;
  // The square of a seed ends at most width - 1 pixels from it, and its pixels without measurement
  // depend on foreground `width` pixels further.
  const int pixels = 2 * rule.width - 1;
  for (std::size_t j = 0; j < rim_tiles.rows.size(); ++j)
    rim_tiles.rows[j] = marked_around(foreground_tiles, j, pixels) & ~front_tiles.rows[j];
}

const TileMask& Work::mark_cells(const TileMask& tiles) {
  const int pixels = (rule.cells + 1) * LabelRule::cell - 1;
  for (std::size_t j = 0; j < cell_tiles_.rows.size(); ++j) {
    const std::uint64_t wanted = marked_around(tiles, j, pixels) & touched.rows[j];
    scratch_tiles_.rows[j] = wanted & ~cell_tiles_.rows[j];
    cell_tiles_.rows[j] |= wanted;
  }
  return scratch_tiles_;
}

}  // namespace penumbra::labelling
