// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/occlusion/region_spans-inl.hpp>

namespace penumbra {
namespace {

/// Cross product of b - a and p - a: twice the area of the triangle.
double turn_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

/// On which side of the line a-b a point lies: -1, 1, or 0 where rounding decides.
int side_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  constexpr double rounding = 1e-12;  // relative, some thousand times that of a double
  const double turn = turn_of(a, b, p);
  const double size = (b - a).cwiseAbs().sum() * (a.cwiseAbs() + b.cwiseAbs() + p.cwiseAbs()).sum();
  return std::abs(turn) <= rounding * size ? 0 : turn < 0 ? -1 : 1;
}

/// Whether the insides of two segments cross; touching is allowed.
bool edges_cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                 const Eigen::Vector2d& d) {
  if (std::max(a.x(), b.x()) < std::min(c.x(), d.x())) return false;
  if (std::max(c.x(), d.x()) < std::min(a.x(), b.x())) return false;
  return side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0;
}

double u_at(const Eigen::Vector2d& top, const Eigen::Vector2d& bottom, double v) {
  return top.x() + (v - top.y()) * ((bottom.x() - top.x()) / (bottom.y() - top.y()));
}

}  // namespace

void PolygonRows::take(std::span<const Eigen::Vector2d> corners) {
  if (corners.size() < 3) region_fault("polygon of ", corners.size(), " corners: needs 3 or more");
  if (corners.size() > PixelPolygon::max_corners)
    region_fault("polygon of ", corners.size(), " corners: ", PixelPolygon::max_corners,
                 " at the most; give a mask instead");
  edges_.clear();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[i + 1 < corners.size() ? i + 1 : 0];
    if (!a.allFinite() || a.cwiseAbs().maxCoeff() > max_coordinate)
      region_fault("polygon corner ", i, " (", a.x(), ", ", a.y(), "): must be numbers up to ",
                   max_coordinate);
    if (a == b) continue;
    if (a.y() <= b.y())
      edges_.push_back({a, b, 1, i});
    else
      edges_.push_back({b, a, -1, i});
  }
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
    return a.top.y() != b.top.y() ? a.top.y() < b.top.y() : a.corner < b.corner;
  });
}

void PolygonRows::check_crossings() const {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& a = edges_[i];
    for (std::size_t j = i + 1; j < edges_.size() && edges_[j].top.y() <= a.bottom.y(); ++j) {
      const Edge& b = edges_[j];
      if (edges_cross(a.top, a.bottom, b.top, b.bottom))
        region_fault("polygon crosses itself: the edges that begin at corners ",
                     std::min(a.corner, b.corner), " and ", std::max(a.corner, b.corner), " cross");
    }
  }
}

/// The integral of u dv along the outline between two heights: there, the area with its sign.
double PolygonRows::area(double top, double bottom) const {
  double sum = 0;
  for (const Edge& edge : edges_) {
    const double v0 = std::max(edge.top.y(), top), v1 = std::min(edge.bottom.y(), bottom);
    if (v0 >= v1) continue;
    const double mid = u_at(edge.top, edge.bottom, v0 + (v1 - v0) / 2) - edges_.front().top.x();
    sum += edge.winding * mid * (v1 - v0);
  }
  return sum;
}

Eigen::Vector2d PolygonRows::middle() const {
  const Eigen::Vector2d origin = edges_.front().top;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double twice = 0;
  for (const Edge& edge : edges_) {
    const double weight = edge.winding * turn_of(origin, edge.top, edge.bottom);
    sum += weight * (edge.top + edge.bottom - 2 * origin);
    twice += weight;
  }
  return origin + sum / (3 * twice);
}

void PolygonRows::add_row(double v, ExtentRows& rows) const {
  constexpr double rounding = 1e-3;  // pixels, of corners that touch an edge by computation
  int winding = 0;
  double first = 0;
  for (std::size_t i = 0; i < crossings_.size(); ++i) {
    const Crossing& here = crossings_[i];
    if (winding != 0 && winding != turn_ && here.u - crossings_[i - 1].u > rounding)
      region_fault("polygon crosses itself, near (", std::lround(here.u), ", ", v, ")");
    if (winding == 0) first = here.u;
    winding += here.winding;
    if (winding == 0) rows.add(v, std::ceil(first), std::ceil(here.u));
  }
}

void PolygonRows::sweep(ExtentRows::Range range, ExtentRows& rows) {
  active_.clear();
  std::size_t next = 0;
  for (double v = range.first; v <= range.last; ++v) {
    for (; next < edges_.size() && edges_[next].top.y() <= v; ++next) active_.push_back(next);
    std::erase_if(active_, [&](std::size_t i) { return edges_[i].bottom.y() <= v; });
    crossings_.clear();
    for (const std::size_t i : active_)
      crossings_.push_back({u_at(edges_[i].top, edges_[i].bottom, v), edges_[i].winding});
    std::sort(crossings_.begin(), crossings_.end(),
              [](const Crossing& a, const Crossing& b) { return a.u < b.u; });
    add_row(v, rows);
  }
}

void PolygonRows::fill(std::span<const Eigen::Vector2d> corners, ExtentRows& rows) {
  take(corners);
  double top = 0, bottom = 0, left = 0, right = 0;
  if (!edges_.empty()) top = bottom = edges_.front().top.y(), left = right = edges_.front().top.x();
  for (const Edge& edge : edges_) {
    bottom = std::max(bottom, edge.bottom.y());
    left = std::min({left, edge.top.x(), edge.bottom.x()});
    right = std::max({right, edge.top.x(), edge.bottom.x()});
  }
  check_crossings();
  const double signed_area = area(top, bottom);
  constexpr double least = 1e-12;  // of the box around it: what rounding leaves of a line
  if (!(std::abs(signed_area) > least * (right - left) * (bottom - top)))
    region_fault("polygon of ", corners.size(), " corners has no area");
  turn_ = signed_area < 0 ? 1 : -1;
  const ExtentRows::Range range = rows.rows(top, bottom);
  sweep(range, rows);
  if (range.cut)
    rows.add_area(std::abs(area(top, -0.5)) + std::abs(area(rows.height() - 0.5, bottom)));
  if (rows.empty()) rows.add_nearest(middle());
}

}  // namespace penumbra
