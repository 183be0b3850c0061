// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <penumbra/targets/region_spans.hpp>

namespace penumbra {
namespace {

/// Number of rows that are sampled for a polygon's area above and below the image.
constexpr double max_outside_rows = 256;

}  // namespace

/// Fills edges_ without horizontal edges, which cross no row.
void RegionSpans::add_edges(std::span<const Eigen::Vector2d> corners) {
  edges_.clear();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[i + 1 < corners.size() ? i + 1 : 0];
    if (!a.allFinite() || a.cwiseAbs().maxCoeff() > max_coordinate)
      region_fault("polygon corner ", i, " (", a.x(), ", ", a.y(), "): must be numbers up to ",
                   max_coordinate);
    if (a.y() < b.y()) edges_.push_back({a, b, 1});
    if (a.y() > b.y()) edges_.push_back({b, a, -1});
  }
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return a.top.y() < b.top.y(); });
}

/// Adds the pixels of row v inside the outline; the row represents `rows` rows. A pixel centre on
/// an edge belongs to the polygon to its right, so that polygons with a common edge share no pixel.
void RegionSpans::add_crossings(double v, double rows) {
  std::sort(crossings_.begin(), crossings_.end(),
            [](const Crossing& a, const Crossing& b) { return a.u < b.u; });
  int winding = 0;
  double first = 0;
  for (const Crossing& here : crossings_) {
    if (winding == 0) first = std::ceil(here.u);
    winding += here.winding;
    if (winding != 0) continue;
    add_row(v, first, std::ceil(here.u));
    covered_ += rows * (std::ceil(here.u) - first);
  }
}

/// Scans the rows first..last, or `max_rows` evenly between them if there are more.
void RegionSpans::scan_edges(double first, double last, double max_rows) {
  const double rows = std::min(last - first + 1, max_rows);
  const double step = (last - first + 1) / rows;
  active_.clear();
  std::size_t next = 0;
  for (double i = 0; i < rows; ++i) {
    const double v = first + (i + 0.5) * step - 0.5;
    for (; next < edges_.size() && edges_[next].top.y() <= v; ++next) active_.push_back(next);
    std::erase_if(active_, [&](std::size_t k) { return edges_[k].bottom.y() <= v; });
    crossings_.clear();
    for (const std::size_t k : active_) {
      const auto& [top, bottom, winding] = edges_[k];
      const double slope = (bottom.x() - top.x()) / (bottom.y() - top.y());
      crossings_.push_back({top.x() + (v - top.y()) * slope, winding});
    }
    add_crossings(v, step);
  }
}

void RegionSpans::take(const PixelPolygon& polygon) {
  const std::span<const Eigen::Vector2d> corners = polygon.corners;
  if (corners.size() < 3) region_fault("polygon of ", corners.size(), " corners: needs 3 or more");
  if (corners.size() > PixelPolygon::max_corners)
    region_fault("polygon of ", corners.size(), " corners: ", PixelPolygon::max_corners,
                 " at the most; give a mask instead");
  add_edges(corners);
  Eigen::AlignedBox2d box;
  double area = 0;  // twice the sum of a triangle fan's areas: an upper bound of the polygon's
  for (std::size_t i = 0; i < corners.size(); ++i) {
    box.extend(corners[i]);
    const Eigen::Vector2d a = corners[i] - corners[0];
    const Eigen::Vector2d b = corners[(i + 1) % corners.size()] - corners[0];
    area += std::abs(a.x() * b.y() - a.y() * b.x());
  }
  constexpr double least = 1e-12;  // of the bounding box: the rounding error of a line
  if (!(area > least * box.volume()))
    region_fault("polygon of ", corners.size(), " corners has no area");
  const double first = std::ceil(box.min().y()), last = std::floor(box.max().y());
  const double bottom = height_ - 1.0;
  scan_edges(first, std::min(last, -1.0), max_outside_rows);
  scan_edges(std::max(first, 0.0), std::min(last, bottom), bottom + 1);
  scan_edges(std::max(first, bottom + 1), last, max_outside_rows);
  if (covered_ == 0) add_nearest(box.center());
}

}  // namespace penumbra
