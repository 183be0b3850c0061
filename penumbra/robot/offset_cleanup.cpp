// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include <penumbra/robot/offset_cleanup-inl.hpp>

namespace penumbra::offset {
namespace {

/// A triangle's run along an edge.
struct Run {
  std::uint32_t lower;
  std::uint32_t higher;
  bool backward;  // from the higher to the lower vertex
  std::uint32_t triangle;
};

std::vector<Run> sorted_runs(const TriangleMesh& mesh) {
  std::vector<Run> runs;
  runs.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[i][k];
      const std::uint32_t to = mesh.triangles[i][(k + 1) % 3];
      runs.push_back({std::min(from, to), std::max(from, to), from > to, i});
    }
  }
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return std::tie(a.lower, a.higher, a.backward, a.triangle) <
           std::tie(b.lower, b.higher, b.backward, b.triangle);
  });
  return runs;
}

/// Cuts a triangle at a point of its edge a-b.
void split(TriangleMesh& mesh, std::uint32_t triangle, std::uint32_t a, std::uint32_t b,
           std::uint32_t point) {
  std::array<std::uint32_t, 3> other = mesh.triangles[triangle];
  std::replace(mesh.triangles[triangle].begin(), mesh.triangles[triangle].end(), a, point);
  std::replace(other.begin(), other.end(), b, point);
  mesh.triangles.push_back(other);
}

/// Separates the edges whose triangles no other edge has cut yet; false if there was none.
bool separate_some(TriangleMesh& mesh) {
  const std::vector<Run> runs = sorted_runs(mesh);
  std::vector<bool> cut(mesh.triangles.size(), false);
  bool any = false;
  for (std::size_t begin = 0, end = 0; begin < runs.size(); begin = end) {
    const Run& first = runs[begin];
    std::size_t forward = 0;
    bool free = true;
    for (; end < runs.size() && runs[end].lower == first.lower && runs[end].higher == first.higher;
         ++end) {
      forward += runs[end].backward ? 0 : 1;
      free = free && !cut[runs[end].triangle];
    }
    if (forward < 2 || end - begin != 2 * forward || !free) continue;
    any = true;
    for (std::size_t pair = 1; pair < forward; ++pair) {
      const float share = static_cast<float>(pair) / static_cast<float>(forward);
      const auto point = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(mesh.vertices[first.lower] * (1.0F - share) +
                              mesh.vertices[first.higher] * share);
      for (const std::size_t i : {begin + pair, begin + forward + pair}) {
        cut[runs[i].triangle] = true;
        split(mesh, runs[i].triangle, first.lower, first.higher, point);
      }
    }
    for (std::size_t i = begin; i < end; ++i) cut[runs[i].triangle] = true;
  }
  return any;
}

}  // namespace

void cancel_opposites(TriangleMesh& mesh) {
  struct Face {
    std::array<std::uint32_t, 3> corners;  // sorted
    bool flipped;
    std::uint32_t index;
  };
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    auto t = mesh.triangles[i];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    const bool flipped = t[1] > t[2];
    if (flipped) std::swap(t[1], t[2]);
    faces.push_back({t, flipped, i});
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return std::tie(a.corners, a.flipped, a.index) < std::tie(b.corners, b.flipped, b.index);
  });
  std::vector<bool> cancelled(faces.size(), false);
  for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
    while (end < faces.size() && faces[end].corners == faces[begin].corners) ++end;
    for (std::size_t i = begin, j = end - 1; i < j && !faces[i].flipped && faces[j].flipped;
         ++i, --j)
      cancelled[faces[i].index] = cancelled[faces[j].index] = true;
  }
  std::size_t index = 0;
  std::erase_if(mesh.triangles, [&](const auto&) { return cancelled[index++]; });
}

void separate_edges(TriangleMesh& mesh) {
  constexpr int passes = 16;  // a triangle may have several such edges
  for (int pass = 0; pass < passes && separate_some(mesh); ++pass) {
  }
}

void separate_vertices(TriangleMesh& mesh) {
  std::set<std::array<float, 3>> taken;
  for (Eigen::Vector3f& v : mesh.vertices) {
    v.array() += 0.0F;  // -0.0 becomes 0.0
    while (!taken.insert({v.x(), v.y(), v.z()}).second)
      v.x() = std::nextafter(v.x(), std::numeric_limits<float>::infinity());
  }
}

void drop_returns(std::vector<std::uint32_t>& loop) {
  std::vector<std::uint32_t> kept;
  for (const std::uint32_t v : loop) {
    if (!kept.empty() && kept.back() == v) continue;
    if (kept.size() > 1 && kept[kept.size() - 2] == v)
      kept.pop_back();
    else
      kept.push_back(v);
  }
  std::size_t begin = 0;  // the loop's end meets its begin
  while (kept.size() - begin > 1) {
    const std::size_t last = kept.size() - 1;
    if (kept[last] == kept[begin]) {
      kept.pop_back();
    } else if (last - begin > 1 && kept[last - 1] == kept[begin]) {
      kept.resize(last - 1);
    } else if (last - begin > 1 && kept[last] == kept[begin + 1]) {
      kept.pop_back();
      ++begin;
    } else {
      break;
    }
  }
  if (kept.size() - begin < 3) begin = kept.size();
  loop.assign(kept.begin() + static_cast<std::ptrdiff_t>(begin), kept.end());
}

}  // namespace penumbra::offset
