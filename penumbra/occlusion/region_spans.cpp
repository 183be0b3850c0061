// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include <penumbra/occlusion/region_spans-inl.hpp>

namespace penumbra {
namespace {

constexpr double most_covered = 0x1p62;  // pixels, which fit a std::size_t

/// The share of an ellipse's area above a level line; `height`: how far below the middle the line
/// lies, as a share of half the ellipse's height.
double share_above(double height) {
  const double t = std::clamp(height, -1.0, 1.0);
  return 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t)) / std::numbers::pi;
}

/// An ellipse by rows: at the height dv below its middle it reaches from shear * dv - half(dv) to
/// shear * dv + half(dv).
struct EllipseRows {
  explicit EllipseRows(const PixelEllipse& ellipse)
      : product(ellipse.semi_axes.x() * ellipse.semi_axes.y()) {
    const double a = ellipse.semi_axes.x(), b = ellipse.semi_axes.y();
    const double c = std::cos(ellipse.angle), s = std::sin(ellipse.angle);
    square = a * a * s * s + b * b * c * c;
    shear = c * s * (a - b) * (a + b) / square;
  }

  [[nodiscard]] double half(double dv) const {
    return product * std::sqrt(std::max(0.0, square - dv * dv)) / square;
  }

  double product;  ///< of the semi-axes
  double square;   ///< of half its height
  double shear;
};

}  // namespace

int first_set(const std::uint8_t* p, int count) {
  constexpr int step = 32;
  int i = 0;
  for (std::array<std::uint64_t, step / 8> words; i + step <= count; i += step) {
    std::memcpy(words.data(), p + i, step);
    if ((words[0] | words[1] | words[2] | words[3]) != 0) break;
  }
  while (i < count && p[i] == 0) ++i;
  return i;
}

SpanBox box_of_spans(std::span<const RowSpan> spans) {
  SpanBox box{spans[0].u0, spans[0].u1 - 1, spans[0].v, spans[0].v};
  for (const RowSpan& span : spans) {
    box.u0 = std::min(box.u0, span.u0), box.u1 = std::max(box.u1, span.u1 - 1);
    box.v0 = std::min(box.v0, span.v), box.v1 = std::max(box.v1, span.v);
  }
  return box;
}

SeenPixels::SeenPixels(ImageView<const std::uint8_t> unseen) {
  if (unseen.empty()) return;
  for (int v = 0; v < unseen.height; ++v) {
    const std::uint8_t* const row = unseen.row(v);
    for (int u = 0; u < unseen.width;) {
      const int first = u;
      while (u < unseen.width && row[u] == 0) ++u;
      if (u > first) spans_.push_back({v, first, u});
      while (u < unseen.width && row[u] != 0) ++u;
    }
    ends_.push_back(spans_.size());
  }
}

std::span<const RowSpan> SeenPixels::row(int v) const {
  const auto i = static_cast<std::size_t>(v);
  const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
  return std::span(spans_).subspan(begin, ends_[i] - begin);
}

bool SeenPixels::hold(const RowSpan& span, int width, int height) const {
  if (span.v < 0 || span.v >= height || span.u0 < 0 || span.u1 > width) return false;
  if (all()) return true;
  const auto covers = [&](const RowSpan& one) { return one.u0 <= span.u0 && span.u1 <= one.u1; };
  const std::span<const RowSpan> seen = row(span.v);
  return std::any_of(seen.begin(), seen.end(), covers);
}

void ExtentRows::keep(const SeenPixels& seen) {
  kept_.clear();
  inside_ = 0;
  for (const RowSpan& span : spans_) {
    for (const RowSpan& part : seen.row(span.v)) {
      const int u0 = std::max(span.u0, part.u0), u1 = std::min(span.u1, part.u1);
      if (u0 >= u1) continue;
      kept_.push_back({span.v, u0, u1});
      inside_ += static_cast<std::size_t>(u1 - u0);
    }
  }
  std::swap(spans_, kept_);
}

void ExtentRows::clear() {
  spans_.clear();
  inside_ = 0;
  covered_ = 0;
}

void ExtentRows::add(double v, double first, double end) {
  if (!(first < end)) return;
  covered_ += end - first;
  const double u0 = std::max(first, 0.0), u1 = std::min(end, static_cast<double>(width_));
  if (v < 0 || v >= height_ || !(u0 < u1)) return;
  spans_.push_back({static_cast<int>(v), static_cast<int>(u0), static_cast<int>(u1)});
  inside_ += static_cast<std::size_t>(u1 - u0);
}

void ExtentRows::add_nearest(const Eigen::Vector2d& point) {
  const double u = std::round(point.x());
  add(std::round(point.y()), u, u + 1);
}

ExtentRows::Range ExtentRows::rows(double top, double bottom) const {
  const double first = std::ceil(top), last = std::floor(bottom);
  const double in_first = std::max(first, 0.0), in_last = std::min(last, height_ - 1.0);
  const double inside = std::max(0.0, in_last - in_first + 1);
  if (last - first + 1 - inside <= max_outside_rows) return {first, last, false};
  return {in_first, in_last, true};
}

std::size_t ExtentRows::covered() const {
  return static_cast<std::size_t>(std::min(std::round(covered_), most_covered));
}

void RegionSpans::fill(const Region& region) {
  rows_.clear();
  std::visit([this](const auto& kind) { take(kind); }, region);
}

void RegionSpans::fill_moved(std::span<const RowSpan> spans, const Eigen::Vector2d& by) {
  rows_.clear();
  const double du = std::round(by.x()), dv = std::round(by.y());
  for (const RowSpan& span : spans) rows_.add(span.v + dv, span.u0 + du, span.u1 + du);
}

Eigen::Vector2d RegionSpans::middle() const {
  double u = 0, v = 0;
  for (const RowSpan& span : spans()) {
    const double pixels = span.u1 - span.u0;
    u += pixels * 0.5 * (span.u0 + span.u1 - 1);
    v += pixels * span.v;
  }
  return Eigen::Vector2d(u, v) / static_cast<double>(inside());
}

void check_region(const Region& region, int width, int height) {
  RegionSpans(width, height).fill(region);
}

void RegionSpans::take(const PixelBox& box) {
  const Eigen::Array4d numbers(box.u, box.v, box.width, box.height);
  const auto fault = [&](const char* what) {
    region_fault("box ", box.u, ", ", box.v, ", ", box.width, " x ", box.height, ": ", what);
  };
  if (!numbers.isFinite().all()) fault("must be numbers");
  if (numbers.abs().maxCoeff() > max_coordinate) fault("is too far out, or too large");
  if (box.width <= 0 || box.height <= 0) fault("has no area: width and height must be above 0");
  const double first = std::ceil(box.u), end = std::ceil(box.u + box.width);
  const double top = std::ceil(box.v), below = std::ceil(box.v + box.height);
  const double v0 = std::max(top, 0.0), v1 = std::min(below, static_cast<double>(rows_.height()));
  for (double v = v0; v < v1; ++v) rows_.add(v, first, end);
  rows_.add_area((end - first) * (below - top - std::max(0.0, v1 - v0)));
  if (rows_.empty()) rows_.add_nearest({box.u + 0.5 * box.width, box.v + 0.5 * box.height});
}

void RegionSpans::check_size(const char* what, int width, int height) const {
  if (width != rows_.width() || height != rows_.height())
    region_fault(what, " of ", width, " x ", height, " pixels: the image has ", rows_.width(),
                 " x ", rows_.height());
}

void RegionSpans::take(const PixelMask& mask) {
  check_size("mask", mask.mask.width, mask.mask.height);
  const int width = rows_.width();
  for (int v = 0; v < rows_.height(); ++v) {
    const std::uint8_t* const row = mask.mask.row(v);
    for (int u = first_set(row, width); u < width;) {
      const void* const zero = std::memchr(row + u, 0, static_cast<std::size_t>(width - u));
      const int end =
          zero == nullptr ? width : static_cast<int>(static_cast<const std::uint8_t*>(zero) - row);
      rows_.add_inside(v, u, end);
      u = end + first_set(row + end, width - end);
    }
  }
  if (rows_.empty()) region_fault("mask without any pixel");
}

/// Opens and closes the spans of rows in which column u differs from the one before it.
void RegionSpans::turn_column(int u) {
  std::size_t i = 0, j = 0;
  bool differs = false;
  int from = 0;
  while (i < last_ends_.size() || j < ends_.size()) {
    const int before = i < last_ends_.size() ? last_ends_[i] : rows_.height();
    const int now = j < ends_.size() ? ends_[j] : rows_.height();
    const int v = std::min(before, now);
    if (differs) {
      for (int row = from; row < v; ++row) {
        int& open = open_[static_cast<std::size_t>(row)];
        if (open != closed) rows_.add_inside(row, open, u);
        open = open == closed ? u : closed;
      }
    }
    from = v;
    if (i < last_ends_.size() && before == v) differs = !differs, ++i;
    if (j < ends_.size() && now == v) differs = !differs, ++j;
  }
  std::swap(last_ends_, ends_);
  ends_.clear();
}

void RegionSpans::take(const RunLengthMask& mask) {
  check_size("run-length mask", mask.width, mask.height);
  const auto height = static_cast<std::uint64_t>(mask.height);
  const std::uint64_t pixels = static_cast<std::uint64_t>(mask.width) * height;
  std::uint64_t total = 0;
  for (const std::uint32_t count : mask.counts) total += count;
  if (total != pixels)
    region_fault("run-length mask: its counts add up to ", total, " pixels, the image has ",
                 pixels);
  last_ends_.clear();
  ends_.clear();
  std::uint64_t at = 0;  // pixels before the run
  std::uint64_t column = 0;
  for (std::size_t i = 0; i < mask.counts.size(); ++i) {
    const std::uint64_t end = at + mask.counts[i];
    // The run from `at` to `end`, cut at the ends of columns.
    while (i % 2 == 1 && at < end) {
      for (; column < at / height; ++column) turn_column(static_cast<int>(column));
      const std::uint64_t cut = std::min(end, (column + 1) * height);
      ends_.push_back(static_cast<int>(at - column * height));
      ends_.push_back(static_cast<int>(cut - column * height));
      at = cut;
    }
    at = end;
  }
  for (; column <= static_cast<std::uint64_t>(mask.width); ++column)
    turn_column(static_cast<int>(column));
  if (rows_.empty()) region_fault("run-length mask without any pixel");
}

void RegionSpans::take(const PixelEllipse& ellipse) {
  const Eigen::Vector2d& centre = ellipse.centre;
  const Eigen::Vector2d& axes = ellipse.semi_axes;
  const auto fault = [&](const char* what) {
    region_fault("ellipse at (", centre.x(), ", ", centre.y(), ") of ", axes.x(), " x ", axes.y(),
                 " pixels: ", what);
  };
  if (!centre.allFinite() || !axes.allFinite() || !std::isfinite(ellipse.angle))
    fault("must be numbers");
  if (axes.minCoeff() <= 0) fault("semi-axes must be above 0");
  if (std::max(axes.maxCoeff(), centre.cwiseAbs().maxCoeff()) > max_coordinate)
    fault("is too far out, or too large");
  const EllipseRows rows(ellipse);
  const double height = std::sqrt(rows.square);
  const ExtentRows::Range range = rows_.rows(centre.y() - height, centre.y() + height);
  for (double v = range.first; v <= range.last; ++v) {
    const double dv = v - centre.y();
    const double u = centre.x() + rows.shear * dv, half = rows.half(dv);
    rows_.add(v, std::ceil(u - half), std::floor(u + half) + 1);
  }
  if (range.cut) {
    const double above = share_above((-0.5 - centre.y()) / height);
    const double below = 1 - share_above((rows_.height() - 0.5 - centre.y()) / height);
    rows_.add_area(std::numbers::pi * rows.product * (above + below));
  }
  if (rows_.empty()) rows_.add_nearest(centre);
}

void RegionSpans::take_depth(const RenderedRegion& region, int v, int u0, int u1) {
  const float* const row = region.depth.row(v);
  for (int u = u0; u < u1;) {
    const int first = u;
    while (u < u1 && row[u] > 0.0f && row[u] <= RenderedRegion::max_depth) ++u;
    if (u > first) rows_.add_inside(v, first, u);
    if (u < u1 && row[u] != 0.0f)
      region_fault("rendered region: depth ", row[u], " at (", u, ", ", v, "): must be 0 to ",
                   RenderedRegion::max_depth, " m");
    while (u < u1 && row[u] == 0.0f) ++u;
  }
}

void RegionSpans::take(const RenderedRegion& region) {
  check_size("rendered region", region.depth.width, region.depth.height);
  if (region.touched == nullptr) {
    for (int v = 0; v < rows_.height(); ++v) take_depth(region, v, 0, rows_.width());
    return;
  }
  check_size("rendered region's tiles", region.touched->width, region.touched->height);
  region.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) take_depth(region, v, u0, u1);
  });
}

}  // namespace penumbra
