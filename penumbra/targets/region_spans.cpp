// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include <penumbra/targets/region_spans.hpp>

namespace penumbra {

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

PixelRectangle box_of_spans(std::span<const RowSpan> spans) {
  PixelRectangle box{spans[0].u0, spans[0].v, spans[0].u1, spans[0].v + 1};
  for (const RowSpan& span : spans) {
    box.u0 = std::min(box.u0, span.u0), box.u1 = std::max(box.u1, span.u1);
    box.v0 = std::min(box.v0, span.v), box.v1 = std::max(box.v1, span.v + 1);
  }
  return box;
}

SeenPixels::SeenPixels(ImageView<const std::uint8_t> unseen) {
  if (unseen.empty()) return;
  seen_ = Image<std::uint8_t>(unseen.width, unseen.height);
  for (int v = 0; v < unseen.height; ++v)
    for (int u = 0; u < unseen.width; ++u) seen_(u, v) = unseen(u, v) == 0 ? 1 : 0;
}

bool SeenPixels::hold(const RowSpan& span, int width, int height) const {
  if (span.v < 0 || span.v >= height || span.u0 < 0 || span.u1 > width) return false;
  return all() || std::memchr(row(span.v) + span.u0, 0,
                              static_cast<std::size_t>(span.u1 - span.u0)) == nullptr;
}

RegionSpans::RegionSpans(int width, int height)
    : width_(width),
      height_(height),
      begins_(static_cast<std::size_t>(height)),
      ends_(static_cast<std::size_t>(height)) {}

void RegionSpans::clear() {
  spans_.clear();
  inside_ = 0;
  covered_ = 0;
}

void RegionSpans::fill(const Region& region) {
  clear();
  std::visit([this](const auto& kind) { take(kind); }, region);
  covered_ = std::max(std::round(covered_), static_cast<double>(inside_));
}

void RegionSpans::fill_scaled(std::span<const RowSpan> spans, double scale,
                              const Eigen::Array2d& by) {
  clear();
  for (const RowSpan& span : spans) {
    // The first pixels whose centres lie at the scaled edges or after them.
    const Eigen::Array2d from = (scale * Eigen::Array2d(span.u0, span.v) + by - 0.5).ceil();
    const Eigen::Array2d end = (scale * Eigen::Array2d(span.u1, span.v + 1) + by - 0.5).ceil();
    const double below = std::min(end.y(), static_cast<double>(height_));
    for (double v = std::max(from.y(), 0.0); v < below; ++v) add_row(v, from.x(), end.x());
    covered_ += (end - from).prod();
  }
}

void RegionSpans::keep(const SeenPixels& seen) {
  if (seen.all()) return;
  std::swap(spans_, kept_);
  spans_.clear();
  inside_ = 0;
  for (const RowSpan& span : kept_) add_bytes(seen.row(span.v), span.v, span.u0, span.u1);
}

std::size_t RegionSpans::covered() const { return static_cast<std::size_t>(covered_); }

Eigen::Vector2d RegionSpans::middle() const {
  double u = 0, v = 0;
  for (const RowSpan& span : spans_) {
    const double pixels = span.u1 - span.u0;
    u += pixels * 0.5 * (span.u0 + span.u1 - 1);
    v += pixels * span.v;
  }
  return Eigen::Vector2d(u, v) / static_cast<double>(inside_);
}

void check_region(const Region& region, int width, int height) {
  RegionSpans(width, height).fill(region);
}

void RegionSpans::add_span(int v, int u0, int u1) {
  if (u0 >= u1) return;
  spans_.push_back({v, u0, u1});
  inside_ += static_cast<std::size_t>(u1 - u0);
}

/// Adds the pixels first <= u < end of row v inside the image; the arguments are whole numbers.
void RegionSpans::add_row(double v, double first, double end) {
  const double u0 = std::max(first, 0.0), u1 = std::min(end, static_cast<double>(width_));
  if (v >= 0 && v < height_ && u0 < u1)
    add_span(static_cast<int>(v), static_cast<int>(u0), static_cast<int>(u1));
}

/// Adds the pixels of [u0, u1) whose bytes are not 0.
void RegionSpans::add_bytes(const std::uint8_t* row, int v, int u0, int u1) {
  for (int u = u0 + first_set(row + u0, u1 - u0); u < u1;) {
    const void* const zero = std::memchr(row + u, 0, static_cast<std::size_t>(u1 - u));
    const int end =
        zero == nullptr ? u1 : static_cast<int>(static_cast<const std::uint8_t*>(zero) - row);
    add_span(v, u, end);
    u = end + first_set(row + end, u1 - end);
  }
}

/// Adds the pixel nearest to a point, for a region that contains no pixel centre.
void RegionSpans::add_nearest(const Eigen::Vector2d& point) {
  const double u = std::round(point.x());
  add_row(std::round(point.y()), u, u + 1);
  covered_ = std::max(covered_, 1.0);
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
  for (double v = std::max(top, 0.0); v < std::min(below, static_cast<double>(height_)); ++v)
    add_row(v, first, end);
  covered_ = (end - first) * (below - top);
  if (covered_ == 0) add_nearest({box.u + 0.5 * box.width, box.v + 0.5 * box.height});
}

/// At the height dv below its centre an ellipse spans shear * dv - half to shear * dv + half.
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
  const double c = std::cos(ellipse.angle), s = std::sin(ellipse.angle);
  const double a = axes.x(), b = axes.y();
  const double square = a * a * s * s + b * b * c * c;  // of half its height
  const double shear = c * s * (a - b) * (a + b) / square;
  const Eigen::Vector2d reach(std::hypot(a * c, b * s), std::sqrt(square));
  const Eigen::Vector2d low = centre - reach, high = centre + reach;
  for (double v = std::max(std::ceil(low.y()), 0.0); v <= std::min(high.y(), height_ - 1.0); ++v) {
    const double dv = v - centre.y(), u = centre.x() + shear * dv;
    const double half = a * b * std::sqrt(std::max(0.0, square - dv * dv)) / square;
    add_row(v, std::ceil(u - half), std::floor(u + half) + 1);
  }
  const bool lies_inside = low.minCoeff() > -1 && high.x() < width_ && high.y() < height_;
  if (!lies_inside) covered_ = std::numbers::pi * a * b;
  if (inside_ == 0) add_nearest(centre);
}

void RegionSpans::check_size(const char* what, int width, int height) const {
  if (width != width_ || height != height_)
    region_fault(what, " of ", width, " x ", height, " pixels: the image has ", width_, " x ",
                 height_);
}

void RegionSpans::take(const PixelMask& mask) {
  check_size("mask", mask.mask.view.width, mask.mask.view.height);
  for (int v = 0; v < height_; ++v) add_bytes(mask.mask.view.row(v), v, 0, width_);
  if (inside_ == 0) region_fault("mask without any pixel");
}

/// Adds the pixels v0..v1 - 1 of column u, after those of the columns to its left.
void RegionSpans::add_column(int u, int v0, int v1) {
  std::int32_t ended = 0;  // rows whose last span ends before u; as wide as u, to vectorise
  for (int v = v0; v < v1; ++v) ended += ends_[static_cast<std::size_t>(v)] != u ? 1 : 0;
  for (int v = v0; v < v1 && ended > 0; ++v) {
    const auto row = static_cast<std::size_t>(v);
    if (ends_[row] == u) continue;
    add_span(v, begins_[row], ends_[row]);
    begins_[row] = u;
  }
  std::fill(ends_.begin() + v0, ends_.begin() + v1, u + 1);
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
  std::fill(begins_.begin(), begins_.end(), -1);
  std::fill(ends_.begin(), ends_.end(), -1);
  std::uint64_t at = 0;  // pixels before the run
  for (std::size_t i = 0; i < mask.counts.size(); ++i) {
    const std::uint64_t end = at + mask.counts[i];
    while (i % 2 == 1 && at < end) {  // split at the ends of columns
      const std::uint64_t u = at / height, cut = std::min(end, (u + 1) * height);
      add_column(static_cast<int>(u), static_cast<int>(at - u * height),
                 static_cast<int>(cut - u * height));
      at = cut;
    }
    at = end;
  }
  for (int v = 0; v < height_; ++v)
    add_span(v, begins_[static_cast<std::size_t>(v)], ends_[static_cast<std::size_t>(v)]);
  if (inside_ == 0) region_fault("run-length mask without any pixel");
}

void RegionSpans::add_depths(const RenderedRegion& region, int v, int u0, int u1) {
  const float* const row = region.depth.view.row(v);
  for (int u = u0; u < u1;) {
    const int first = u;
    while (u < u1 && row[u] > 0.0f && row[u] <= RenderedRegion::max_depth) ++u;
    add_span(v, first, u);
    if (u < u1 && row[u] != 0.0f)
      region_fault("rendered region: depth ", row[u], " at (", u, ", ", v, "): must be 0 to ",
                   RenderedRegion::max_depth, " m");
    while (u < u1 && row[u] == 0.0f) ++u;
  }
}

void RegionSpans::take(const RenderedRegion& region) {
  check_size("rendered region", region.depth.view.width, region.depth.view.height);
  if (region.touched == nullptr) {
    for (int v = 0; v < height_; ++v) add_depths(region, v, 0, width_);
    return;
  }
  check_size("rendered region's tiles", region.touched->width, region.touched->height);
  region.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) add_depths(region, v, u0, u1);
  });
}

}  // namespace penumbra
