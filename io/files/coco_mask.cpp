// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#include <io/files/coco_mask.hpp>

namespace penumbra::io {
namespace {

using Row = std::vector<std::uint8_t>;

/// A pixel at which a run begins.
struct Start {
  int column, row;
};

/// Appends the columns in which two rows differ. Their sizes are multiples of 8.
void add_differences(const Row& above, const Row& row, int v, std::vector<Start>& starts) {
  for (std::size_t u = 0; u < row.size(); u += 8) {
    std::uint64_t a = 0;
    std::uint64_t b = 0;
    std::memcpy(&a, &above[u], sizeof(a));
    std::memcpy(&b, &row[u], sizeof(b));
    if (a == b) continue;
    for (std::size_t i = u; i < u + 8; ++i)
      if (above[i] != row[i]) starts.push_back({static_cast<int>(i), v});
  }
}

/// Returns where runs begin, in the order of columns; the first run is outside of the mask.
std::vector<std::int64_t> starts_of_runs(ImageView<const float> depth) {
  const auto width = static_cast<std::size_t>(depth.width);
  Row first((width + 7) / 8 * 8);
  Row above(first.size());
  Row row(first.size());
  std::vector<Start> inner;  // below another pixel of the column
  for (int v = 0; v < depth.height; ++v) {
    const float* const pixels = depth.row(v);
    std::transform(pixels, pixels + width, row.begin(),
                   [](float z) { return static_cast<std::uint8_t>(z > 0.0F); });
    if (v == 0)
      first = row;
    else
      add_differences(above, row, v, inner);
    std::swap(above, row);
  }
  // The row `above` is the last one now. A column follows the one before.
  std::vector<std::size_t> end(width + 1);
  const auto begins = [&](std::size_t u) { return first[u] != (u == 0 ? 0 : above[u - 1]); };
  for (const Start& start : inner) ++end[static_cast<std::size_t>(start.column) + 1];
  for (std::size_t u = 0; u < width; ++u) end[u + 1] += end[u] + (begins(u) ? 1 : 0);
  std::vector<std::int64_t> starts(end[width]);
  for (std::size_t u = 0; u < width; ++u)
    if (begins(u)) starts[end[u]++] = static_cast<std::int64_t>(u) * depth.height;
  for (const Start& start : inner)
    starts[end[static_cast<std::size_t>(start.column)]++] =
        std::int64_t{start.column} * depth.height + start.row;
  return starts;
}

void append(std::int64_t value, std::string& text) {
  for (bool more = true; more;) {
    const std::int64_t group = value & 31;
    value >>= 5;
    more = value != ((group & 16) != 0 ? -1 : 0);
    text += static_cast<char>(group + 48 + (more ? 32 : 0));
  }
}

}  // namespace

CocoMask coco_mask(ImageView<const float> depth) {
  CocoMask mask;
  std::vector<std::int64_t> ends = starts_of_runs(depth);
  const std::int64_t height = depth.height;
  ends.push_back(height * depth.width);
  std::int64_t top = height;
  std::int64_t bottom = -1;
  std::int64_t begin = 0;
  std::vector<std::int64_t> counts;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const std::int64_t count = ends[i] - begin;
    append(count - (i > 2 ? counts[i - 2] : 0), mask.counts);
    counts.push_back(count);
    if (i % 2 == 1) {
      const bool is_in_one = begin / height == (ends[i] - 1) / height;
      top = std::min(top, is_in_one ? begin % height : 0);
      bottom = std::max(bottom, is_in_one ? (ends[i] - 1) % height : height - 1);
      mask.area += count;
    }
    begin = ends[i];
  }
  if (mask.area == 0) return mask;
  const auto left = static_cast<int>(ends[0] / height);
  const std::int64_t last = ends.size() % 2 == 0 ? ends.back() : ends[ends.size() - 2];
  const auto right = static_cast<int>((last - 1) / height);
  mask.box = {left, static_cast<int>(top), right - left + 1, static_cast<int>(bottom - top + 1)};
  return mask;
}

std::optional<std::vector<std::uint32_t>> decoded_counts(std::string_view text) {
  std::vector<std::int64_t> runs;
  for (std::size_t i = 0; i < text.size();) {
    std::int64_t value = 0;
    for (unsigned shift = 0, letter = 0x20; (letter & 0x20U) != 0; shift += 5) {
      if (i >= text.size() || shift > 30) return std::nullopt;
      letter = static_cast<unsigned char>(text[i++]) - 48U;
      value |= static_cast<std::int64_t>(letter & 0x1FU) << shift;
      const bool is_last = (letter & 0x20U) == 0;
      if (is_last && (letter & 0x10U) != 0) value -= std::int64_t{1} << (shift + 5);
    }
    if (runs.size() > 2) value += runs[runs.size() - 2];
    runs.push_back(value);
  }
  std::vector<std::uint32_t> counts;
  for (const std::int64_t run : runs) {
    if (run < 0 || run > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    counts.push_back(static_cast<std::uint32_t>(run));
  }
  return counts;
}

}  // namespace penumbra::io
