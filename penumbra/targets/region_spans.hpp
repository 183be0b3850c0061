// SPDX-License-Identifier: Apache-2.0
// Regions as spans of pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <sstream>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/error.hpp>
#include <penumbra/base/image.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// Throws InputError for an invalid region or target.
template <typename... Parts>
[[noreturn]] void region_fault(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw InputError(message.str());
}

/// Returns the index of the first of `count` bytes that is not 0, or `count` if all are 0.
[[nodiscard]] int first_set(const std::uint8_t* p, int count);

/// Returns the bounding box of one or more spans.
[[nodiscard]] PixelRectangle box_of_spans(std::span<const RowSpan> spans);

/// Returns a box with a border, which may reach out of the image.
[[nodiscard]] inline PixelRectangle grown(const PixelRectangle& box, int du, int dv) {
  return {box.u0 - du, box.v0 - dv, box.u1 + du, box.v1 + dv};
}

/// The pixels of an image that the camera saw.
class SeenPixels {
 public:
  /// `unseen`: not 0 for pixels that it did not see; empty: it saw every pixel.
  explicit SeenPixels(ImageView<const std::uint8_t> unseen);

  [[nodiscard]] bool all() const { return seen_.empty(); }
  [[nodiscard]] const std::uint8_t* row(int v) const { return seen_.view().row(v); }
  /// Returns whether the camera saw all pixels of a span. The span may lie outside the image.
  [[nodiscard]] bool hold(const RowSpan& span, int width, int height) const;

 private:
  Image<std::uint8_t> seen_;  // 1: seen; empty: all are
};

/// The pixels of a region: those inside the image as spans, those outside as a count by area.
/// Allocates nothing for regions no larger than earlier ones.
class RegionSpans {
 public:
  RegionSpans(int width, int height);

  /// Sets the region. Throws InputError if it is invalid.
  void fill(const Region& region);

  /// Sets spans of an image of this size, scaled about its first corner and then moved.
  void fill_scaled(std::span<const RowSpan> spans, double scale, const Eigen::Array2d& by);

  /// Moves pixels that the camera did not see to those outside the image.
  void keep(const SeenPixels& seen);

  [[nodiscard]] std::span<const RowSpan> spans() const { return spans_; }
  [[nodiscard]] std::size_t inside() const { return inside_; }
  /// Returns the number of pixels inside and outside the image.
  [[nodiscard]] std::size_t covered() const;
  /// Returns the centroid of the pixels inside; there must be one.
  [[nodiscard]] Eigen::Vector2d middle() const;

 private:
  struct Edge {
    Eigen::Vector2d top, bottom;  // by v
    int winding;                  // 1 if the outline runs down, else -1
  };
  struct Crossing {
    double u;
    int winding;
  };

  void take(const PixelBox& box);
  void take(const PixelEllipse& ellipse);
  void take(const PixelPolygon& polygon);
  void take(const PixelMask& mask);
  void take(const RunLengthMask& mask);
  void take(const RenderedRegion& region);

  void clear();
  void check_size(const char* what, int width, int height) const;
  void add_span(int v, int u0, int u1);
  void add_row(double v, double first, double end);
  void add_bytes(const std::uint8_t* row, int v, int u0, int u1);
  void add_column(int u, int v0, int v1);
  void add_depths(const RenderedRegion& region, int v, int u0, int u1);
  void add_nearest(const Eigen::Vector2d& point);
  void add_edges(std::span<const Eigen::Vector2d> corners);
  void scan_edges(double first, double last, double max_rows);
  void add_crossings(double v, double rows);

  int width_, height_;
  std::vector<RowSpan> spans_, kept_;
  std::size_t inside_ = 0;
  double covered_ = 0;              // inside and outside
  std::vector<int> begins_, ends_;  // last span of each row while a run-length mask is read
  std::vector<Edge> edges_;         // of a polygon, sorted by top
  std::vector<std::size_t> active_;
  std::vector<Crossing> crossings_;
};

}  // namespace penumbra
